// A part of a mesh with fewer triangles and the same border.
#pragma once

#include <span>

#include "packs/build/surface_error.h"
#include "packs/page.h"

namespace delray::packs::internal {

// The pages as one mesh, in which vertices that are alike to the last bit are one.
scenes::Mesh merge(std::span<const Page> pages);

struct Simplified {
  scenes::Mesh mesh;     // its vertices are some of the original; triangles ordered for locality
  SurfaceErrors errors;  // of its triangles; see surface_errors
};

// About kKept of the triangles, of which each was so far from the surface `before`, as
// surface_errors has it. Vertices on the border, edges with a single triangle, stay. The result has
// as many triangles as before where nothing could be left out. Deterministic.
inline constexpr double kKept = 0.5;
Simplified simplify(const scenes::Mesh& mesh, std::span<const float> before = {});

}  // namespace delray::packs::internal
