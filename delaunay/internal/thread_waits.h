// Which thread waits for which simplex, and whether one more would close a circle.
#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

#include "delaunay/dag.h"

namespace delray::delaunay::internal {

// Threads enter before they wait and leave when they have locked the simplex, before they do
// anything else; so what a thread holds cannot change while it is entered, and the last thread of a
// circle to enter sees the whole of it.
class ThreadWaits {
 public:
  explicit ThreadWaits(std::size_t threads) : node_(threads, kNoNode) {}

  // Enters `thread` (from 0) unless its waiting for `node` would close a circle: then returns
  // false and the owner of the node (1 + its number), which waits until `thread` unlocks.
  template <int D>
  bool enter(const Dag<D>& dag, std::uint32_t thread, NodeNumber node, std::uint32_t& owner) {
    const std::lock_guard guard(mutex_);
    owner = dag.owner(node);
    NodeNumber wanted = node;
    for (std::size_t steps = 0; steps <= node_.size(); ++steps) {
      const std::uint32_t holder = dag.owner(wanted);
      if (holder == 0) break;
      if (holder == thread + 1) {
        if (steps == 0) break;
        return false;
      }
      const NodeNumber next = node_[holder - 1];
      // A thread that has what it wants is about to leave.
      if (next == kNoNode || dag.owner(next) == holder) break;
      wanted = next;
    }
    node_[thread] = node;
    return true;
  }

  void leave(std::uint32_t thread) {
    const std::lock_guard guard(mutex_);
    node_[thread] = kNoNode;
  }

 private:
  std::mutex mutex_;
  std::vector<NodeNumber> node_;  // what each thread waits for
};

}  // namespace delray::delaunay::internal
