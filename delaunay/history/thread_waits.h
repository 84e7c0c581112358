// The record of which thread waits for which simplex, to find circles of waiting threads.
#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

#include "delaunay/flip/dag.h"

namespace delray::delaunay::internal {

// The record is that of the node when the thread found it a leaf.
struct HeldLeaf {
  NodeNumber node = kNoNode;
  RecordNumber record = kNoRecord;
};

// Threads enter before they wait and leave when they have locked the simplex, before they do
// anything else; so what a thread holds cannot change while it is entered, and the last thread of a
// circle to enter sees the whole of it.
class ThreadWaits {
 public:
  explicit ThreadWaits(std::size_t threads) : wanted_(threads) {}

  // Enters `thread` (from 0) unless its waiting for `leaf` would close a circle: then returns
  // false and the owner of the leaf (1 + its number), which waits until `thread` unlocks.
  template <int D>
  bool enter(const Dag<D>& dag, std::uint32_t thread, HeldLeaf leaf, std::uint32_t& owner) {
    const std::lock_guard guard(mutex_);
    HeldLeaf wanted = leaf;
    for (std::size_t steps = 0; steps <= wanted_.size(); ++steps) {
      const std::uint32_t holder = dag.owner(wanted.node, wanted.record);
      if (steps == 0) owner = holder;
      if (holder == 0 || holder == kReplaced) break;
      if (holder == thread + 1) {
        if (steps == 0) break;
        return false;
      }
      const HeldLeaf next = wanted_[holder - 1];
      // A thread that has what it wants is about to leave.
      if (next.node == kNoNode || dag.owner(next.node, next.record) == holder) break;
      wanted = next;
    }
    wanted_[thread] = leaf;
    return true;
  }

  void leave(std::uint32_t thread) {
    const std::lock_guard guard(mutex_);
    wanted_[thread] = {};
  }

 private:
  std::mutex mutex_;
  std::vector<HeldLeaf> wanted_;  // what each thread waits for
};

}  // namespace delray::delaunay::internal
