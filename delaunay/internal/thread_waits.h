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
  explicit ThreadWaits(std::size_t threads) : node_(threads, kNoNode), robbed_(threads, false) {}

  // Enters `thread` (from 0) unless its waiting for `node` would close a circle: then returns
  // false, and if `rob`, the owner of the node is told that its simplices are being changed. It
  // waits until `thread` unlocks.
  template <int D>
  bool enter(const Dag<D>& dag, std::uint32_t thread, NodeNumber node, bool rob,
             std::uint32_t& owner) {
    const std::lock_guard guard(mutex_);
    owner = dag.owner(node);
    NodeNumber wanted = node;
    for (std::size_t steps = 0; steps <= node_.size(); ++steps) {
      const std::uint32_t holder = dag.owner(wanted);
      if (holder == 0) break;
      if (holder == thread + 1) {
        if (steps == 0) break;
        if (rob) robbed_[owner - 1] = true;
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

  // Returns whether the thread was robbed since it entered.
  bool leave(std::uint32_t thread) {
    const std::lock_guard guard(mutex_);
    node_[thread] = kNoNode;
    const bool robbed = robbed_[thread];
    robbed_[thread] = false;
    return robbed;
  }

 private:
  std::mutex mutex_;
  std::vector<NodeNumber> node_;  // what each thread waits for
  std::vector<bool> robbed_;
};

}  // namespace delray::delaunay::internal
