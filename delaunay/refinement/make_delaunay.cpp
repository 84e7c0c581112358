// Lawson's flips (1977), of pieces of segments, too. O(n) where there is nothing to flip.
#include "delaunay/refinement/make_delaunay.h"

#include <vector>

#include "delaunay/flip/flip_2d.h"
#include "delaunay/predicates/conflict.h"

namespace delray::delaunay::internal {
namespace {

// Flips as flip() does, and keeps marks of edges. Those of the flipped edge go.
void flip_with_marks(RefinementMesh& mesh, CornerNumber corner) {
  const CornerNumber beyond = mesh.mesh.neighbour(corner);
  const CornerNumber right = next_corner(corner), left = previous_corner(corner);
  const CornerNumber beyond_right = previous_corner(beyond), beyond_left = next_corner(beyond);
  const bool near_left = mesh.is_segment(right), near_right = mesh.is_segment(left),
             far_left = mesh.is_segment(beyond_right), far_right = mesh.is_segment(beyond_left);
  flip(mesh.mesh, corner);
  const auto bit = [](CornerNumber at, bool is_one) {
    return static_cast<std::uint8_t>(is_one ? 1U << (at & 3U) : 0U);
  };
  const auto inside = [&](CornerNumber at) {
    return static_cast<std::uint8_t>(mesh.marks(simplex_of(at)) & RefinementMesh::kInside);
  };
  mesh.set_marks(
      simplex_of(corner),
      static_cast<std::uint8_t>(inside(corner) | bit(corner, far_right) | bit(left, near_right)));
  mesh.set_marks(simplex_of(beyond),
                 static_cast<std::uint8_t>(inside(beyond) | bit(beyond, near_left) |
                                           bit(beyond_right, far_left)));
}

}  // namespace

void make_delaunay(RefinementMesh& mesh) {
  std::vector<CornerNumber> suspects;
  const auto is_wrong = [&](CornerNumber corner) {
    const VertexNumber v = mesh.mesh.vertex(corner);
    return v != kInfiniteVertex &&
           conflict(mesh.mesh, mesh.places(), simplex_of(mesh.mesh.neighbour(corner)),
                    mesh.points[v]);
  };
  for (SimplexNumber t = 0; t < mesh.triangles; ++t) {
    if (mesh.mesh.is_dead(t)) continue;
    for (unsigned k = 0; k < 3; ++k) {
      const CornerNumber corner = corner_of(t, k);
      if (corner < mesh.mesh.neighbour(corner) && is_wrong(corner)) suspects.push_back(corner);
    }
  }
  while (!suspects.empty()) {
    const CornerNumber corner = suspects.back();
    suspects.pop_back();
    if (!is_wrong(corner)) continue;
    const SimplexNumber across = simplex_of(mesh.mesh.neighbour(corner));
    flip_with_marks(mesh, corner);
    for (const SimplexNumber t : {simplex_of(corner), across}) {
      for (unsigned k = 0; k < 3; ++k) suspects.push_back(corner_of(t, k));
    }
  }
}

}  // namespace delray::delaunay::internal
