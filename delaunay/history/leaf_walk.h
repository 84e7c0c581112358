// The walk over leaves of a history that other threads change, in any dimension.
#pragma once

#include "delaunay/flip/dag.h"

namespace delray::delaunay::internal {

// See walk_to(). `is_beyond(node, k)` tells whether the point is strictly beyond facet k of a node.
template <int D, class IsBeyond>
NodeNumber walk_over_leaves(const Dag<D>& dag, NodeNumber node, IsBeyond&& is_beyond) {
  // From one point of a round along a curve to the next it takes some ten.
  constexpr int kLongest = 128;
  unsigned back = D + 1;  // the point is not beyond the facet that the walk came through
  for (int step = 0; step < kLongest; ++step) {
    if (dag.is_abandoned(node)) return kNoNode;
    if (const Children children = dag.children(node); children.count > 0) {
      node = children.first;
      back = D + 1;
      continue;
    }
    unsigned k = 0;
    while (k <= D && (k == back || !is_beyond(node, k))) ++k;
    if (k > D) return node;
    const CornerNumber beyond = dag.neighbour_if_leaf(corner_of(node, k));
    if (beyond != kNoCorner) {
      node = simplex_of(beyond);
      back = beyond & 3;
    } else if (dag.is_leaf(node)) {
      return kNoNode;
    }
  }
  return kNoNode;
}

}  // namespace delray::delaunay::internal
