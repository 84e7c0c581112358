// A part of a mesh with fewer triangles and the same border.
#pragma once

#include <span>
#include <vector>

#include "packs/page.h"

namespace delray::packs::internal {

// The pages as one mesh, in which vertices that are alike to the last bit are one.
scenes::Mesh merge(std::span<const Page> pages);

// About kKept of the triangles, ordered for locality. Vertices on the border, edges with a single
// triangle, stay, and others are some of those before. The result has as many triangles as before
// where nothing could be left out. Deterministic.
inline constexpr double kKept = 0.5;
scenes::Mesh simplify(const scenes::Mesh& mesh);

// What a difference of 1 between normals, colours or texture coordinates counts as: see
// surface_errors.
float attribute_scale(const scenes::Mesh& before);

}  // namespace delray::packs::internal
