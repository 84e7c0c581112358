// Flips of facets that are not Delaunay on the leaves of a 3D history. One thread flips until
// nothing on its stack can be flipped, then all facets are tested again: facets may remain that no
// flip mends, and then the caller has to start anew.
#include <optional>
#include <vector>

#include "delaunay/history/delaunay_repair.h"
#include "delaunay/history/sole_dag_access.h"
#include "delaunay/history/wrong_corners.h"

namespace delray::delaunay::internal {
namespace {

// Remembers what was created.
class NotingAccess : public SoleDagAccess<3> {
 public:
  using SoleDagAccess::SoleDagAccess;

  NodeNumber create(const std::array<VertexNumber, 4>& vertices) {
    made.push_back(SoleDagAccess::create(vertices));
    return made.back();
  }

  std::vector<NodeNumber> made;
};

// The corner at one side of a facet, with a finite vertex.
CornerNumber finite_side(const Dag<3>& dag, CornerNumber corner) {
  return dag.vertex(corner) != kInfiniteVertex ? corner : dag.neighbour(corner);
}

// Whether the facet opposite a corner of a leaf is not in the Delaunay triangulation of the five
// vertices around it. The same from both sides.
bool is_wrong(const DagTriangulation<3>& triangulation, CornerNumber corner) {
  const CornerNumber near = finite_side(triangulation.dag, corner);
  return conflict(triangulation.dag, triangulation.orientation,
                  simplex_of(triangulation.dag.neighbour(near)),
                  triangulation.points[triangulation.dag.vertex(near)]);
}

std::vector<CornerNumber> wrong_facets(const DagTriangulation<3>& triangulation,
                                       std::size_t threads) {
  return wrong_corners(triangulation.dag, threads,
                       [&](CornerNumber corner) { return is_wrong(triangulation, corner); });
}

// Flips until nothing wrong is left that can be flipped. Returns how many leaves were made.
std::uint64_t flip_all(const DagTriangulation<3>& triangulation, std::vector<CornerNumber>& open) {
  NotingAccess access(triangulation.dag, 0);
  std::vector<CornerNumber> suspects;
  Flips3d flips(triangulation.dag, triangulation.orientation, access, suspects);
  std::uint64_t made = 0;
  while (!open.empty()) {
    const CornerNumber corner = open.back();
    open.pop_back();
    // The leaves that replaced one have brought their own facets.
    if (!triangulation.dag.is_leaf(simplex_of(corner)) || !is_wrong(triangulation, corner)) {
      continue;
    }
    access.made.clear();
    flips.flip_facet(finite_side(triangulation.dag, corner));
    made += access.made.size();
    for (const NodeNumber node : access.made) {
      for (unsigned k = 0; k < 4; ++k) open.push_back(corner_of(node, k));
    }
  }
  return made;
}

}  // namespace

std::optional<std::uint64_t> repair(const DagTriangulation<3>& triangulation, std::size_t threads) {
  std::vector<CornerNumber> open = wrong_facets(triangulation, threads);
  if (open.empty()) return 0;
  const std::uint64_t made = flip_all(triangulation, open);
  if (!wrong_facets(triangulation, threads).empty()) return std::nullopt;
  return made;
}

}  // namespace delray::delaunay::internal
