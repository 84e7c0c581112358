// Splitting vertices whose corners disagree.
#pragma once

#include <cstdint>
#include <span>

#include "scenes/scene.h"

namespace delray::scenes::internal {

// Makes corners of one vertex that carry different labels refer to different vertices: the first
// label met, in the order of the triangles, keeps the vertex; for each other label a copy of the
// vertex with all its attributes is appended. Corner c is vertex c % 3 of triangle c / 3.
// O(n log n), however many labels a vertex has. REQUIRES: labels.size() == 3 * triangles.
void split_vertices(Mesh& mesh, std::span<const std::uint32_t> labels);

}  // namespace delray::scenes::internal
