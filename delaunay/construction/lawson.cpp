// An edge that is to be flipped is the diagonal of a strictly convex quadrilateral, so that each
// flip makes two triangles; it lowers the surface of the points on the paraboloid, so that no edge
// comes back.
#include "delaunay/construction/lawson.h"

#include <vector>

#include "delaunay/flip/flip_2d.h"
#include "delaunay/predicates/conflict.h"

namespace delray::delaunay::internal {

std::uint64_t flip_to_delaunay(Mesh<2>& mesh, std::span<const glm::dvec2> points) {
  std::vector<CornerNumber> suspects;
  for (SimplexNumber t = 0; t < mesh.size(); ++t) {
    for (unsigned k = 0; k < 3 && !mesh.is_dead(t); ++k) suspects.push_back(corner_of(t, k));
  }
  std::uint64_t flips = 0;
  while (!suspects.empty()) {
    const CornerNumber corner = suspects.back();
    suspects.pop_back();
    const SimplexNumber here = simplex_of(corner), across = simplex_of(mesh.neighbour(corner));
    if (mesh.is_ghost(here) || mesh.is_ghost(across)) continue;
    if (!conflict(mesh, points, across, points[mesh.vertex(corner)])) continue;
    flip(mesh, corner);
    ++flips;
    for (unsigned k = 0; k < 3; ++k) {
      suspects.push_back(corner_of(here, k));
      suspects.push_back(corner_of(across, k));
    }
  }
  return flips;
}

}  // namespace delray::delaunay::internal
