// HXT's parallel Delaunay triangulation in space (Marot et al. 2019) out of Gmsh's library (GPL;
// here only).
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <span>

namespace delray::bench {

struct HxtResult {
  double seconds = 0;          // from points in memory to tetrahedra in memory
  std::size_t tetrahedra = 0;  // finite ones
};

// Its tie-break is its own: on degenerate points its tetrahedra are not CGAL's, nor their number.
// Errors: std::runtime_error.
HxtResult triangulate_with_hxt(std::span<const glm::dvec3> points, int threads);

}  // namespace delray::bench
