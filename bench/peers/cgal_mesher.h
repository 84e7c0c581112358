// CGAL's Delaunay_mesher_2: Ruppert's refinement of constrained triangulations (GPL; here only).
#pragma once

#include <cstddef>

#include "delaunay/outline.h"

namespace delray::bench {

// What a refinement took and made.
struct MesherRun {
  double seconds = 0;
  std::size_t points = 0;  // of the result
};

// From an outline in memory, in CGAL's own type, to the refined triangulation in memory. Without
// segments the edges of the hull are those. Triangles may have any size.
MesherRun refine_with_cgal(const delaunay::Outline& outline, double min_angle);

}  // namespace delray::bench
