// A list is a run for each page that it refers to: the page, how many triangles follow, and 16 bits
// for each of them, the lower 13 its number.
#include "packs/build/references.h"

#include <cassert>
#include <cstring>

namespace delray::packs::internal {
namespace {

constexpr unsigned kNumberBits = 13;
constexpr std::uint16_t kNumberMask = (1U << kNumberBits) - 1;

template <class T>
void put(const T& value, std::vector<std::byte>& to) {
  const auto* const bytes = reinterpret_cast<const std::byte*>(&value);
  to.insert(to.end(), bytes, bytes + sizeof value);
}

template <class T>
T take(std::span<const std::byte>& from) {
  T value;
  std::memcpy(&value, from.data(), sizeof value);
  from = from.subspan(sizeof value);
  return value;
}

}  // namespace

std::vector<std::byte> encode(std::span<const Reference> references) {
  std::vector<std::byte> bytes;
  for (std::size_t i = 0; i < references.size();) {
    std::size_t end = i;
    while (end < references.size() && references[end].page == references[i].page) ++end;
    put(references[i].page, bytes);
    put(static_cast<std::uint32_t>(end - i), bytes);
    for (; i < end; ++i) {
      assert(references[i].triangle <= kNumberMask);
      put(static_cast<std::uint16_t>(references[i].triangle | references[i].corners << kNumberBits),
          bytes);
    }
  }
  return bytes;
}

ReferenceLists::ReferenceLists(const std::filesystem::path& folder)
    : file_(folder, "what pages stand for") {}

void ReferenceLists::append(std::span<const std::byte> list) {
  const std::uint64_t begin = ends_.empty() ? 0 : ends_.back();
  file_.write(begin, list);
  ends_.push_back(begin + list.size());
}

void ReferenceLists::read(std::size_t i, std::vector<Reference>& to) const {
  const std::uint64_t begin = i == 0 ? 0 : ends_[i - 1];
  std::vector<std::byte> bytes(ends_[i] - begin);
  file_.read(begin, bytes);
  for (std::span<const std::byte> left = bytes; !left.empty();) {
    const auto page = take<std::uint32_t>(left);
    for (auto n = take<std::uint32_t>(left); n > 0; --n) {
      const auto packed = take<std::uint16_t>(left);
      to.push_back({page, static_cast<std::uint16_t>(packed & kNumberMask),
                    static_cast<std::uint8_t>(packed >> kNumberBits)});
    }
  }
}

}  // namespace delray::packs::internal
