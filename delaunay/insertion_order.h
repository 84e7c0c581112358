// In which order points are inserted.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string_view>
#include <vector>

namespace delray::delaunay {

// The numbers of the points in the order called `name` (see orders() in methods.h):
// - random: a random permutation;
// - hilbert: along a Hilbert curve over the bounding box, 2^16 cells across;
// - brio: random rounds, each twice as large as the one before, along the curve within each: short
//   walks as on a curve, and yet the expected cost of a random order (Amenta, Choi, Rote 2003).
// O(n log n). REQUIRES: one of these names; finite coordinates.
std::vector<std::uint32_t> insertion_order(std::span<const glm::dvec2> points,
                                           std::string_view name, std::uint64_t seed);

}  // namespace delray::delaunay
