// Location in the history of a 2D triangulation. A node has two or three children around a common
// apex, so one or two orientation tests against the edges at the apex choose the next node; the
// layout of children is that of subdivisions and flips. A walk crosses edges between leaves
// instead. Degenerate: a point on an edge belongs to either side.
#include "delaunay/history/dag_location.h"

#include "delaunay/history/leaf_walk.h"

namespace delray::delaunay {

NodeNumber root_of(const Dag<2>& dag, const Orientation<2>& orientation, const glm::dvec2& q) {
  for (NodeNumber root = 0; root + 1 < kRoots<2>; ++root) {
    bool inside = true;
    for (unsigned k = 0; k < 3 && inside; ++k) {
      const CornerNumber corner = corner_of(root, k);
      inside =
          orientation(dag.vertex(next_corner(corner)), dag.vertex(previous_corner(corner)), q) >= 0;
    }
    if (inside) return root;
  }
  return kRoots<2> - 1;
}

NodeNumber descend(const Dag<2>& dag, const Orientation<2>& orientation, NodeNumber node,
                   const glm::dvec2& q) {
  for (;;) {
    const auto [first, count] = dag.children(node);
    if (count == 0) return node;
    const NodeNumber second = first + 1, third = first + 2;
    const VertexNumber a = dag.vertex(corner_of(first, 0)), b = dag.vertex(corner_of(first, 1)),
                       apex = dag.vertex(corner_of(first, 2));
    // Only the node's inner edges decide, those at the apex.
    const int at_b = orientation(b, apex, q);
    if (count == 2) {
      node = at_b >= 0 ? first : second;
      continue;
    }
    if (at_b >= 0 && orientation(apex, a, q) >= 0) {
      node = first;
      continue;
    }
    const VertexNumber c = dag.vertex(corner_of(second, 1));
    node = at_b <= 0 && orientation(c, apex, q) >= 0 ? second : third;
  }
}

NodeNumber walk_to(const Dag<2>& dag, const Orientation<2>& orientation, NodeNumber start,
                   const glm::dvec2& q) {
  return internal::walk_over_leaves(dag, start, [&](NodeNumber node, unsigned k) {
    const CornerNumber corner = corner_of(node, k);
    return orientation(dag.vertex(next_corner(corner)), dag.vertex(previous_corner(corner)), q) < 0;
  });
}

}  // namespace delray::delaunay
