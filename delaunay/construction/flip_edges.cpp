// An edge that is to be flipped is the diagonal of a strictly convex quadrilateral, so that each
// flip makes two triangles. By circles a flip lowers the surface of the points on the paraboloid,
// so that no edge comes back; by angles it makes the ascending list of all angles larger.
#include "delaunay/construction/flip_edges.h"

#include <vector>

#include "delaunay/construction/smallest_angles.h"
#include "delaunay/flip/flip_2d.h"
#include "delaunay/predicates/conflict.h"

namespace delray::delaunay::internal {
namespace {

// Flips edges between finite triangles of which is_wrong(corner) is true, the edge opposite to the
// corner.
template <class IsWrong>
std::uint64_t flip_edges(Mesh<2>& mesh, IsWrong&& is_wrong) {
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
    if (!is_wrong(corner)) continue;
    flip(mesh, corner);
    ++flips;
    for (unsigned k = 0; k < 3; ++k) {
      suspects.push_back(corner_of(here, k));
      suspects.push_back(corner_of(across, k));
    }
  }
  return flips;
}

}  // namespace

std::uint64_t flip_to_delaunay(Mesh<2>& mesh, std::span<const glm::dvec2> points) {
  return flip_edges(mesh, [&](CornerNumber corner) {
    return conflict(mesh, points, simplex_of(mesh.neighbour(corner)), points[mesh.vertex(corner)]);
  });
}

std::uint64_t flip_to_largest_angles(Mesh<2>& mesh, std::span<const glm::dvec2> points) {
  return flip_edges(mesh, [&](CornerNumber corner) {
    const auto at = [&](CornerNumber c) { return points[mesh.vertex(c)]; };
    const glm::dvec2 near = at(corner), right = at(next_corner(corner)),
                     far = at(mesh.neighbour(corner)), left = at(previous_corner(corner));
    const bool is_convex = orient2d(near, right, far) > 0 && orient2d(far, left, near) > 0;
    return is_convex && has_larger_angles(near, right, far, left);
  });
}

}  // namespace delray::delaunay::internal
