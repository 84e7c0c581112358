// In which order points are inserted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string_view>
#include <vector>

namespace delray::delaunay {

// The numbers of the points in the order called `name` (see orders() in methods.h):
// - random: a random permutation;
// - hilbert: along a Hilbert curve over the bounding box, 2^16 cells across (2^20 in space);
// - brio: random rounds, each twice as large as the one before, along the curve within each: short
//   walks as on a curve, and yet the expected cost of a random order (Amenta, Choi, Rote 2003).
// Every round goes along the curve from the point that is `start` of the way and round to there
// again. O(n log n); up to so many threads. Throws std::invalid_argument for other names and unless
// 0 <= start < 1. REQUIRES: finite coordinates.
std::vector<std::uint32_t> insertion_order(std::span<const glm::dvec2> points,
                                           std::string_view name, std::uint64_t seed,
                                           double start = 0, std::size_t threads = 1);
std::vector<std::uint32_t> insertion_order(std::span<const glm::dvec3> points,
                                           std::string_view name, std::uint64_t seed,
                                           double start = 0, std::size_t threads = 1);

}  // namespace delray::delaunay
