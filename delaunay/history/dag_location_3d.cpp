// Location in the history of a 3D triangulation. Children of a node are separated by facets that
// they share, so one orientation test for each further child keeps the one that contains the point.
// A walk crosses facets between leaves instead. Degenerate: a point on a facet belongs to either
// side.
#include <array>

#include "delaunay/history/dag_location.h"
#include "delaunay/history/leaf_walk.h"
#include "delaunay/insertion/orientation_3d.h"

namespace delray::delaunay {
namespace {

std::array<VertexNumber, 4> vertices_of(const Dag<3>& dag, NodeNumber node) {
  return {dag.vertex(corner_of(node, 0)), dag.vertex(corner_of(node, 1)),
          dag.vertex(corner_of(node, 2)), dag.vertex(corner_of(node, 3))};
}

}  // namespace

NodeNumber root_of(const Dag<3>& dag, const Orientation<3>& orientation, const glm::dvec3& q) {
  for (NodeNumber root = 0; root + 1 < kRoots<3>; ++root) {
    bool inside = true;
    for (unsigned k = 0; k < 4 && inside; ++k) {
      inside = orientation.with(q, k, vertices_of(dag, root)) >= 0;
    }
    if (inside) return root;
  }
  return kRoots<3> - 1;
}

NodeNumber descend(const Dag<3>& dag, const Orientation<3>& orientation, NodeNumber node,
                   const glm::dvec3& q) {
  for (;;) {
    const auto [first, count] = dag.children(node);
    if (count == 0) return node;
    NodeNumber best = first;
    // Child k lacks corner k of the node, so the facet opposite to corner j of one child separates
    // it from child j. Of what contains q, one child after the other is compared with the best.
    for (unsigned j = 1; j < count; ++j) {
      if (orientation.with(q, j, vertices_of(dag, best)) < 0) best = first + j;
    }
    node = best;
  }
}

NodeNumber walk_to(const Dag<3>& dag, const Orientation<3>& orientation, NodeNumber start,
                   const glm::dvec3& q) {
  return internal::walk_over_leaves(dag, start, [&](NodeNumber node, unsigned k) {
    return orientation.with(q, k, vertices_of(dag, node)) < 0;
  });
}

}  // namespace delray::delaunay
