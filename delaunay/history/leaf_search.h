// Finding the leaves of the history that one thread's points lie in.
#pragma once

#include <string_view>

#include "delaunay/flip/dag.h"
#include "delaunay/flip/dag_flip_2d.h"
#include "delaunay/flip/dag_flip_3d.h"
#include "delaunay/history/dag_location.h"

namespace delray::delaunay::internal {

// By `location`: "dag", down the history from a root; or "walk", from the last point's leaf, and
// down the history if that does not lead there soon.
template <int D>
class LeafSearch {
 public:
  LeafSearch(const DagTriangulation<D>& triangulation, std::string_view location)
      : triangulation_(triangulation), walks_(location == "walk") {}

  // A node that contains q, its boundary included, and was a leaf when it was read. Any number of
  // other threads may insert points that do so through HeldLeaves.
  template <class Point>
  NodeNumber find(const Point& q) {
    NodeNumber node =
        walks_ ? walk_to(triangulation_.dag, triangulation_.orientation, last_, q) : kNoNode;
    if (node == kNoNode) node = from_root(q);
    last_ = node;
    return node;
  }
  // As find(), after the node that it found is no leaf any more, or could not be acquired.
  template <class Point>
  NodeNumber find_below(NodeNumber node, const Point& q) {
    // Somebody may have undone what the walk has led to.
    if (walks_ && triangulation_.dag.is_abandoned(node)) return from_root(q);
    return descend(triangulation_.dag, triangulation_.orientation, node, q);
  }

 private:
  template <class Point>
  NodeNumber from_root(const Point& q) const {
    return descend(triangulation_.dag, triangulation_.orientation,
                   root_of(triangulation_.dag, triangulation_.orientation, q), q);
  }

  const DagTriangulation<D>& triangulation_;
  bool walks_;
  NodeNumber last_ = 0;
};

}  // namespace delray::delaunay::internal
