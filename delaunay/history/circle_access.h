// The access policy of the circum-circle method: geometry in place of locks.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <thread>
#include <vector>

#include "delaunay/flip/dag_flip_2d.h"
#include "delaunay/history/current_points.h"
#include "delaunay/history/node_cache.h"
#include "delaunay/mesh/flip_counter.h"
#include "delaunay/triangulate.h"
#include "parallel/team.h"

namespace delray::delaunay::internal {

// A thread may touch a simplex unless the point of another lies inside its circumcircle or is one
// of its vertices.
//
// Whatever a thread retires contains its own point in that sense, and it asks for all neighbours of
// that too. So the simplices of one thread's operation and of another's are at most beside a common
// third, of which each writes a link of its own: the threads see each other's points, or one of
// them, which came first, is seen by the other and waits. Since links of acquired simplices may
// change on their far side, operations look again at those that they have read before. A thread
// whose waiting would close a circle ignores the point of the one that it would wait for, until its
// own commit(), for the reasons of BurglarLocks. kCounted: whether to count.
template <bool kCounted>
class CircleAccess : public FlipCounter {
 public:
  static constexpr bool kMayRetry = true;

  CircleAccess(const DagTriangulation<2>& triangulation, parallel::Team& team,
               CurrentPoints& current, std::uint32_t thread)
      : triangulation_(triangulation),
        team_(team),
        current_(current),
        thread_(thread),
        cache_(triangulation.dag, thread),
        robbed_(current.threads()) {}

  // To be called before the first node is acquired for a vertex.
  void begin(VertexNumber vertex) { current_.set(thread_, vertex); }

  // Never kRefused. kRetry if it has waited, with nothing acquired.
  Grant acquire(std::initializer_list<NodeNumber> nodes) {
    if (kCounted) ++counts_.lock_calls;
    for (std::size_t other = 0; other < current_.threads(); ++other) {
      if (other == thread_ || robbed_[other]) continue;
      const VertexNumber vertex = current_.of(other);
      if (vertex == kNoVertex) continue;
      for (const NodeNumber node : nodes) {
        if (!is_inside(vertex, node)) continue;
        if (kCounted) ++counts_.waits;
        if (wait_or_rob(other, vertex)) return Grant::kRetry;
        break;
      }
    }
    if (kCounted) counts_.free += nodes.size();
    return Grant::kGranted;
  }

  void reserve(NodeNumber count) { cache_.reserve(count); }
  NodeNumber create(const std::array<VertexNumber, 3>& vertices) {
    return cache_.create(vertices, 0);
  }
  void link(CornerNumber outside, CornerNumber inside) {
    triangulation_.dag.set_neighbour(inside, outside);
    triangulation_.dag.set_neighbour(outside, inside);
  }
  // Without locks nobody knows who looks at the neighbours of the leaf, so its record stays its
  // own.
  void retire(NodeNumber node, const std::array<NodeNumber, 3>& children) {
    triangulation_.dag.set_children(node, children);
  }

  void commit() {
    current_.set(thread_, kNoVertex);
    if (robs_) robbed_.assign(robbed_.size(), false);
    robs_ = false;
  }

  // Whether this thread ever ignored a point.
  bool has_robbed() const { return has_robbed_; }
  const Synchronization& counts() const { return counts_; }

 private:
  bool is_inside(VertexNumber vertex, NodeNumber node) const {
    for (unsigned k = 0; k < 3; ++k) {
      if (triangulation_.dag.vertex(corner_of(node, k)) == vertex) return true;
    }
    return conflict(triangulation_, node, triangulation_.points[vertex]);
  }

  // Returns whether it has waited.
  bool wait_or_rob(std::size_t other, VertexNumber vertex) {
    if (!current_.enter(thread_, other, vertex)) {
      robbed_[other] = robs_ = has_robbed_ = true;
      if (kCounted) ++counts_.deadlocks;
      if (kCounted) ++counts_.burglaries;
      return false;
    }
    while (current_.of(other) == vertex) {
      std::this_thread::yield();
      team_.check();
    }
    current_.leave(thread_);
    return true;
  }

  const DagTriangulation<2>& triangulation_;
  parallel::Team& team_;
  CurrentPoints& current_;
  std::uint32_t thread_;
  NodeCache<2> cache_;
  std::vector<bool> robbed_;  // thread i, by this one, since its last commit
  bool robs_ = false, has_robbed_ = false;
  Synchronization counts_;
};

}  // namespace delray::delaunay::internal
