// Most of a cluster are arrays of three numbers for each vertex or triangle: every third word goes
// to one sequence, of which neighbours are alike.
#include "raytrace/clusters/compress_cluster.h"

#include <cstdint>
#include <cstring>
#include <vector>

#include "comm/bad_message.h"
#include "packs/word_planes.h"

namespace delray::raytrace {
namespace {

constexpr std::size_t kSequences = 3, kWord = sizeof(std::uint32_t);
constexpr std::uint64_t kMostExpansion = 256;  // LZ4's

std::size_t words_of(std::size_t bytes) {
  const std::size_t group = kSequences * kWord;
  return (bytes + group - 1) / group * kSequences;
}

}  // namespace

comm::Buffer compress(const ClusterData& cluster) {
  const comm::Buffer packed = pack(cluster);
  std::vector<std::uint32_t> words(words_of(packed.size()));
  if (!packed.empty()) std::memcpy(words.data(), packed.data(), packed.size());
  std::vector<char> planes;
  planes.reserve(words.size() * kWord);
  for (std::size_t k = 0; k < kSequences && k < words.size(); ++k)
    packs::append_planes(words.data() + k, words.size() / kSequences, kSequences, planes);
  const std::vector<char> compressed = packs::compress(planes);
  const std::uint64_t size = packed.size();
  comm::Buffer message(sizeof(size) + compressed.size());
  std::memcpy(message.data(), &size, sizeof(size));
  if (!compressed.empty())
    std::memcpy(message.data() + sizeof(size), compressed.data(), compressed.size());
  return message;
}

ClusterData decompress_cluster(std::span<const std::byte> message) {
  std::uint64_t size = 0;
  comm::check_message(message.size() >= sizeof(size));
  std::memcpy(&size, message.data(), sizeof(size));
  const std::span<const std::byte> compressed = message.subspan(sizeof(size));
  comm::check_message(size <= kMostExpansion * compressed.size());
  std::vector<std::uint32_t> words(words_of(size));
  std::vector<char> planes(words.size() * kWord);
  comm::check_message(packs::decompress(
      {reinterpret_cast<const char*>(compressed.data()), compressed.size()}, planes));
  const std::size_t each = words.size() / kSequences;
  packs::read_planes(planes.data(), each, static_cast<int>(kSequences), words.data());
  return unpack_cluster({reinterpret_cast<const std::byte*>(words.data()), size});
}

}  // namespace delray::raytrace
