// The access policy of the burglary method: a lock in every simplex, and no journal.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "delaunay/flip/dag.h"
#include "delaunay/flip/dag_access.h"
#include "delaunay/history/held_leaves.h"
#include "delaunay/history/lock_mutexes.h"
#include "delaunay/history/thread_waits.h"
#include "delaunay/mesh/add_counts.h"
#include "delaunay/mesh/flip_counter.h"
#include "delaunay/triangulate.h"
#include "parallel/team.h"

namespace delray::delaunay::internal {

// State that the threads of a run share.
struct Burglaries {
  Burglaries(std::size_t count, const Options& options)
      : threads(count),
        unlocks_early(options.unlock == "early"),
        mutexes(options.locks),
        waits(count) {}

  std::size_t threads;
  bool unlocks_early;
  LockMutexes mutexes;
  ThreadWaits waits;
};

// Simplices stay locked until commit(), with options.unlock early but for those that the insertion
// keeps (see keep()), and nothing is ever undone.
//
// A thread whose waiting would close a circle breaks into the simplices of the thread that it would
// wait for, until its own commit(). Nobody else uses them meanwhile: their owner waits for a
// simplex, whose owner waits, and so on to the burglar; of such a chain only the last thread runs,
// and if that comes to wait another may become the last. Threads wait between operations only, so
// what is broken into is a triangulation; but whoever has waited may find it changed, be it robbed
// or a burglar itself, and is told so. kCounted: whether to count;
// kPlain: see HeldLeaves.
template <int D, bool kCounted, bool kPlain>
class BurglarLocks : public FlipCounter {
 public:
  static constexpr bool kMayRetry = true;

  BurglarLocks(Dag<D>& dag, parallel::Team& team, Burglaries& shared, std::uint32_t thread)
      : dag_(dag),
        team_(team),
        waits_(shared.waits),
        early_(shared.unlocks_early),
        held_(dag, shared.mutexes, thread),
        robbed_(shared.threads) {}

  // Never kRefused.
  Grant acquire(std::initializer_list<NodeNumber> nodes) {
    if (kCounted) ++counts_.lock_calls;
    for (const NodeNumber node : nodes) {
      RecordNumber record = kNoRecord;
      const std::uint32_t owner = held_.try_lock(node, record);
      if (owner == kReplaced) return Grant::kRetry;
      if (owner == held_.owner() || (owner != 0 && robbed_[owner - 1])) {
        if (kCounted) ++counts_.already_locked;
        continue;
      }
      if (owner == 0) {
        if (kCounted) ++counts_.free;
        continue;
      }
      if (kCounted) ++counts_.waits;
      if (wait_or_rob(node, record)) return Grant::kRetry;
    }
    return Grant::kGranted;
  }

  void reserve(NodeNumber count) { held_.reserve(count); }
  NodeNumber create(const std::array<VertexNumber, D + 1>& vertices) {
    return held_.create(vertices);
  }
  void link(CornerNumber outside, CornerNumber inside) {
    dag_.set_neighbour(inside, outside);
    dag_.set_neighbour(outside, inside);
  }
  void retire(NodeNumber node, const std::array<NodeNumber, D + 1>& children) {
    held_.retire(node, children);
  }

  // See tell_kept(). Neighbours of what the insertion replaced stay what they are. Not once the
  // insertion has had to wait: others see it unfinished since then, and whom this thread has robbed
  // sleeps only for as long as it holds what that thread waits for.
  void keep(NodeNumber node) {
    if (!kPlain && early_ && !is_shown_ && held_.unlock(node) && kCounted) ++counts_.unlocked_early;
  }

  void commit() {
    if (kCounted) add_list(counts_.lock_lists, held_.size());
    held_.commit();
    if (robs_) robbed_.assign(robbed_.size(), false);
    robs_ = is_shown_ = false;
  }

  // Whether this thread ever was a burglar.
  bool has_robbed() const { return has_robbed_; }
  Synchronization counts() const {
    Synchronization counts = counts_;
    held_.count_mutexes(counts);
    return counts;
  }

 private:
  // Returns whether it has waited, or the leaf was replaced.
  bool wait_or_rob(NodeNumber node, RecordNumber record) {
    held_.show();
    is_shown_ = true;
    const std::uint32_t owner = held_.wait(node, record, waits_, team_);
    if (owner == 0 || owner == kReplaced) return true;
    robbed_[owner - 1] = robs_ = has_robbed_ = true;
    if (kCounted) ++counts_.deadlocks;
    if (kCounted) ++counts_.burglaries;
    return !dag_.is_leaf(node);
  }

  Dag<D>& dag_;
  parallel::Team& team_;
  ThreadWaits& waits_;
  bool early_;
  HeldLeaves<D, kPlain> held_;
  std::vector<bool> robbed_;  // thread i, by this one, since its last commit
  bool robs_ = false, has_robbed_ = false;
  bool is_shown_ = false;  // whether others may see what the insertion has made so far
  Synchronization counts_;
};

}  // namespace delray::delaunay::internal
