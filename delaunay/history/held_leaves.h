// The leaves that one thread has locked.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <thread>
#include <vector>

#include "delaunay/flip/dag.h"
#include "delaunay/history/lock_mutexes.h"
#include "delaunay/history/node_cache.h"
#include "delaunay/history/thread_waits.h"
#include "delaunay/triangulate.h"
#include "parallel/team.h"

namespace delray::delaunay::internal {

// Whether HeldLeaves may be plain.
inline bool is_plain(const Options& options) {
  return options.locks == "atomic" && options.unlock == "end";
}

// Leaves stay locked until commit() or undo(), also if they are replaced meanwhile, by whomsoever,
// unless they are given back by unlock(): a thread that waits for a leaf waits until its owner is
// done with everything. What the thread
// creates meanwhile is locked too, since others may walk by.
//
// kPlain: by atomic instructions, and unlock() is not called.
template <int D, bool kPlain>
class HeldLeaves {
 public:
  HeldLeaves(Dag<D>& dag, LockMutexes& mutexes, std::uint32_t thread)
      : dag_(dag), mutexes_(mutexes), owner_(thread + 1), cache_(dag, thread) {}

  std::uint32_t owner() const { return owner_; }
  // How many it holds, new ones among them.
  std::size_t size() const { return held_.size() - unlocked_ + created_.size(); }

  // As Dag::try_lock(), and `record` is the node's.
  std::uint32_t try_lock(NodeNumber node, RecordNumber& record) {
    if (cache_.is_new(node)) return owner_;
    record = dag_.record_if_leaf(node);
    return record == kNoRecord ? kReplaced : try_again(node, record);
  }
  std::uint32_t try_again(NodeNumber node, RecordNumber record) {
    const std::uint32_t before = test_and_set(node, record);
    if (before == 0) held_.push_back({node, record});
    return before;
  }
  // Waits unless that closes a circle. Returns as try_lock(), the owner if it must not wait.
  // Waiting is short and rare: the thread yields rather than sleeps (Kohout 2004, 7.7.1).
  std::uint32_t wait(NodeNumber node, RecordNumber record, ThreadWaits& waits,
                     const parallel::Team& team) {
    std::uint32_t before = 0;
    if (!waits.enter(dag_, owner_ - 1, {node, record}, before)) return before;
    for (;;) {
      before = try_again(node, record);
      if (before == 0 || before == kReplaced) break;
      std::this_thread::yield();
      team.check();
    }
    waits.leave(owner_ - 1);
    return before;
  }

  // Gives a leaf back before the end. Returns whether it was this thread's, and not a new one.
  //
  // REQUIRES: the insertion keeps the leaf, and has linked it to a leaf that stays locked. Nobody
  // can replace it, then, without that one; and the link is this thread's own to restore.
  bool unlock(NodeNumber node) {
    if (cache_.is_new(node)) return false;
    const RecordNumber record = dag_.record_if_leaf(node);
    if (record == kNoRecord || dag_.owner(node, record) != owner_) return false;
    dag_.set_owner(node, record, 0);
    ++unlocked_;
    return true;
  }

  void reserve(NodeNumber count) { cache_.reserve(count); }
  NodeNumber create(const std::array<VertexNumber, D + 1>& vertices) {
    const NodeNumber node = cache_.create(vertices, owner_);
    created_.push_back({node, dag_.record_of(node)});
    return node;
  }
  bool is_new(NodeNumber node) const { return cache_.is_new(node); }
  // REQUIRES: locked or new.
  void retire(NodeNumber leaf, const std::array<NodeNumber, D + 1>& children) {
    retired_.push_back({leaf, children});
  }

  // Lets others see all that was done, though it stays locked.
  void show() {
    held_.insert(held_.end(), created_.begin(), created_.end());
    created_.clear();
    for (const Retired& retired : retired_) dag_.set_children(retired.leaf, retired.children);
    retired_.clear();
    cache_.forget_new();
  }
  void commit() {
    for (const Retired& retired : retired_) dag_.set_children(retired.leaf, retired.children);
    release();
  }
  // As if nothing had been created or retired. REQUIRES: nothing was shown.
  void undo() {
    for (const HeldLeaf& created : created_) dag_.abandon(created.node);
    release();
  }

  void count_mutexes(Synchronization& counts) const {
    counts.mutex_locks = mutex_counts_.entered;
    counts.mutex_waits = mutex_counts_.contended;
  }

 private:
  struct Retired {
    NodeNumber leaf;
    std::array<NodeNumber, D + 1> children;
  };

  std::uint32_t test_and_set(NodeNumber node, RecordNumber record) {
    if (kPlain || mutexes_.empty()) return dag_.try_lock(node, record, owner_);
    // As with the instruction, looking comes before trying.
    const std::uint32_t before = dag_.owner(node, record);
    return before == 0 ? mutexes_.try_lock(dag_, node, record, owner_, mutex_counts_) : before;
  }
  // The records of what is no leaf any more will serve others.
  void release(const HeldLeaf& leaf) {
    if (dag_.is_leaf(leaf.node)) {
      dag_.set_owner(leaf.node, leaf.record, 0);
    } else {
      dag_.set_owner(kNoNode, leaf.record, 0);
      cache_.recycle(leaf.record);
    }
  }
  void release() {
    for (const HeldLeaf& held : held_) {
      if constexpr (!kPlain) {
        // What was given back may be another thread's by now, or this one's for the second time.
        if (unlocked_ > 0 && dag_.owner(held.node, held.record) != owner_) continue;
      }
      release(held);
    }
    for (const HeldLeaf& created : created_) release(created);
    held_.clear();
    created_.clear();
    retired_.clear();
    unlocked_ = 0;
    cache_.forget_new();
  }

  Dag<D>& dag_;
  LockMutexes& mutexes_;  // none: by atomic instructions
  LockMutexes::Counts mutex_counts_;
  std::uint32_t owner_;
  NodeCache<D> cache_;
  std::vector<HeldLeaf> held_, created_;
  std::size_t unlocked_ = 0;  // of held_, before the end
  std::vector<Retired> retired_;
};

}  // namespace delray::delaunay::internal
