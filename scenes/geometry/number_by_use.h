// Numbers of vertices in the order in which triangles have them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "scenes/none.h"

namespace delray::scenes::internal {

inline constexpr std::size_t kMostNumberedTriangles = kNone / 3;

// Sets number[v] to how many vertices have a first corner before that of vertex v, and gives the
// triangles these numbers; vertices that no triangle has keep kNone. Returns how many have one.
// Parallel; O(triangles + vertices), and nothing for each of them besides `number`.
//
// REQUIRES: every element of `number`, one for each vertex, is kNone; there are at most
// kMostNumberedTriangles.
std::size_t number_by_first_corner(std::span<glm::uvec3> triangles,
                                   std::vector<std::uint32_t>& number);

}  // namespace delray::scenes::internal
