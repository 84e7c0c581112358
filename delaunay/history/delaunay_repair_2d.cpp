// Lawson's flips (1977) on the leaves of a 2D history. All edges are tested in parallel; one thread
// flips those that are wrong and pushes the four edges around each flip on a stack until it is
// empty. In the plane this always ends at the Delaunay triangulation, as ties on common circles are
// decided too (conflict.h).
#include "delaunay/history/delaunay_repair.h"

#include <array>
#include <vector>

#include "delaunay/history/sole_dag_access.h"
#include "delaunay/history/wrong_corners.h"

namespace delray::delaunay::internal {
namespace {

// Whether the edge opposite a corner of a leaf is not in the Delaunay triangulation of the four
// vertices around it. The same from both sides.
bool is_wrong(const DagTriangulation<2>& triangulation, CornerNumber corner) {
  const CornerNumber beyond = triangulation.dag.neighbour(corner);
  const VertexNumber near = triangulation.dag.vertex(corner),
                     far = triangulation.dag.vertex(beyond);
  return near != kInfiniteVertex
             ? conflict(triangulation, simplex_of(beyond), triangulation.points[near])
             : conflict(triangulation, simplex_of(corner), triangulation.points[far]);
}

}  // namespace

std::uint64_t repair(const DagTriangulation<2>& triangulation, std::size_t threads) {
  std::vector<CornerNumber> suspects =
      wrong_corners(triangulation.dag, threads,
                    [&](CornerNumber corner) { return is_wrong(triangulation, corner); });
  if (suspects.empty()) return 0;
  SoleDagAccess<2> access(triangulation.dag, 0);
  std::uint64_t replaced = 0;
  while (!suspects.empty()) {
    const CornerNumber corner = suspects.back();
    suspects.pop_back();
    // The leaves that replaced one have brought their own suspects.
    if (!triangulation.dag.is_leaf(simplex_of(corner)) || !is_wrong(triangulation, corner)) {
      continue;
    }
    std::array<NodeNumber, 2> made{};
    flip(triangulation, corner, access, made);
    replaced += 2;
    for (const CornerNumber outer : {corner_of(made[0], 1), corner_of(made[0], 2),
                                     corner_of(made[1], 0), corner_of(made[1], 2)}) {
      suspects.push_back(outer);
    }
  }
  return replaced;
}

}  // namespace delray::delaunay::internal
