// Vertices of meshes as a whole, and an order of places.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scenes/scene.h"

namespace delray::packs::internal {

// Appends vertex i of a mesh with all attributes that it has.
void copy_vertex(const scenes::Mesh& from, std::size_t i, scenes::Mesh& to);

// The numbers of the places as scenes::order_points has them. O(n log n).
//
// REQUIRES: places are finite.
std::vector<std::uint32_t> order_along_curve(std::span<const glm::vec3> places);

}  // namespace delray::packs::internal
