// A part of a mesh with fewer triangles and the same border.
#pragma once

#include <span>

#include "packs/page.h"

namespace delray::packs::internal {

// The pages as one mesh, in which vertices that are alike to the last bit are one.
scenes::Mesh merge(std::span<const Page> pages);

struct Simplified {
  scenes::Mesh mesh;  // its vertices are some of the original; triangles ordered for locality
  float error = 0;    // see surface_error
};

// About half of the triangles. Vertices on the border, edges with a single triangle, stay. The
// result has as many triangles as before where nothing could be left out. Deterministic.
Simplified simplify(const scenes::Mesh& mesh);

}  // namespace delray::packs::internal
