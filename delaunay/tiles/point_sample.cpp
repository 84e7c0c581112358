// Ranks add up how many of their points each halving would leave, and keep what is not too much.
#include "delaunay/tiles/point_sample.h"

#include <algorithm>
#include <array>
#include <bit>
#include <functional>

#include "comm/collectives.h"

namespace delray::delaunay {

void PointSample::add(const PointSample& other) {
  if (other.highest_ < highest_) lower(other.highest_);
  for (const Kept& each : other.kept_) {
    if (each.hash <= highest_) keep(each.hash, each.place);
  }
}

void PointSample::lower(std::uint64_t highest) {
  highest_ = highest;
  std::erase_if(kept_, [&](const Kept& each) { return each.hash > highest_; });
}

std::vector<glm::dvec3> PointSample::gather(comm::Communicator& communicator) && {
  highest_ = comm::all_reduce_value(
      communicator, highest_, [](std::uint64_t a, std::uint64_t b) { return std::min(a, b); });
  lower(highest_);
  // How many hashes need so many bits.
  std::array<std::uint64_t, 65> counts{};
  for (const Kept& each : kept_) ++counts[static_cast<std::size_t>(std::bit_width(each.hash))];
  comm::all_reduce(communicator, std::span<std::uint64_t>(counts), std::plus<>());
  std::uint64_t sum = 0;
  std::size_t bits = 0;
  while (bits < counts.size() && (bits == 0 || sum + counts[bits] <= most_)) sum += counts[bits++];
  if (bits < counts.size()) lower(std::min(highest_, (std::uint64_t{1} << (bits - 1)) - 1));

  std::vector<glm::dvec3> mine;
  mine.reserve(kept_.size());
  for (const Kept& each : kept_) mine.push_back(each.place);
  kept_ = {};
  const std::span<const glm::dvec3> places = mine;
  if (communicator.size() == 1) return mine;
  std::vector<glm::dvec3> all;
  for (const comm::Buffer& each : comm::gather(communicator, 0, comm::Buffer::of(places))) {
    const auto some = each.as<glm::dvec3>();
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

}  // namespace delray::delaunay
