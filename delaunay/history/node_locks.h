// The access policy of the optimistic method: a lock in every simplex, and a journal.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <initializer_list>
#include <mutex>
#include <thread>
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

// State that the threads of a run share to lock simplices, and to decide who waits.
struct Blocking {
  Blocking(std::size_t threads, const Options& options)
      : by_priority(options.deadlocks == "priorities"),
        unlocks_early(options.unlock == "early"),
        mutexes(options.locks),
        waits(threads),
        priorities(threads) {
    for (std::size_t i = 0; i < threads; ++i) priorities[i].store(i, std::memory_order_relaxed);
  }

  bool by_priority, unlocks_early;
  LockMutexes mutexes;
  ThreadWaits waits;
  std::vector<std::atomic<std::uint64_t>> priorities;
  std::mutex raising;
};

// Simplices stay locked until commit() or rollback(), and no other thread ever builds on what is
// undone. With options.unlock early, those that the insertion keeps are given back before that: a
// boundary simplex that another thread changes meanwhile gets links on other facets only, since for
// all else that thread needs the new simplex beyond, which stays locked. After a rollback the
// thread finds it replaced, and rolls back in turn. kCounted: whether to count;
// kPlain: see HeldLeaves.
template <int D, bool kCounted, bool kPlain>
class NodeLocks : public FlipCounter {
 public:
  static constexpr bool kMayRetry = false;

  NodeLocks(Dag<D>& dag, parallel::Team& team, Blocking& blocking, std::uint32_t thread)
      : dag_(dag),
        team_(team),
        blocking_(blocking),
        thread_(thread),
        priorities_(blocking.by_priority),
        early_(blocking.unlocks_early),
        held_(dag, blocking.mutexes, thread) {}

  Grant acquire(std::initializer_list<NodeNumber> nodes) {
    if (kCounted) ++counts_.lock_calls;
    for (const NodeNumber node : nodes) {
      RecordNumber record = kNoRecord;
      std::uint32_t owner = held_.try_lock(node, record);
      if (owner == held_.owner()) {
        if (kCounted) ++counts_.already_locked;
        continue;
      }
      if (owner == 0) {
        if (kCounted) ++counts_.free;
        continue;
      }
      if (owner != kReplaced) {
        if (kCounted) ++counts_.waits;
        owner = priorities_ ? wait_by_priority(node, record)
                            : held_.wait(node, record, blocking_.waits, team_);
        if (owner == 0) continue;
      }
      if (owner != kReplaced) {
        if (kCounted) ++counts_.deadlocks;
        refused_ = {node, record};
        refuser_ = owner;
      }
      return Grant::kRefused;
    }
    return Grant::kGranted;
  }

  void reserve(NodeNumber count) { held_.reserve(count); }
  NodeNumber create(const std::array<VertexNumber, D + 1>& vertices) {
    return held_.create(vertices);
  }
  void link(CornerNumber outside, CornerNumber inside) {
    // Simplices that are undone altogether need no journal.
    if (!held_.is_new(simplex_of(outside))) {
      journal_.push_back({outside, dag_.neighbour(outside)});
    }
    dag_.set_neighbour(outside, inside);
    dag_.set_neighbour(inside, outside);
  }
  void retire(NodeNumber node, const std::array<NodeNumber, D + 1>& children) {
    held_.retire(node, children);
  }

  // See tell_kept(). Neighbours of what the insertion replaced stay what they are.
  void keep(NodeNumber node) {
    if (!kPlain && early_ && held_.unlock(node) && kCounted) ++counts_.unlocked_early;
  }

  void commit() {
    count_lists();
    held_.commit();
    journal_.clear();
  }
  void rollback() {
    if (kCounted && !journal_.empty()) ++counts_.rollbacks;
    count_lists();
    for (std::size_t i = journal_.size(); i-- > 0;) {
      dag_.set_neighbour(journal_[i].corner, journal_[i].neighbour);
    }
    journal_.clear();
    held_.undo();
    if (priorities_) raise_priority();
    // Trying again at once would only be in the way of the thread that waits for what was just
    // unlocked. Waiting here closes no circle, since there is nothing locked.
    while (refused_.node != kNoNode && dag_.owner(refused_.node, refused_.record) == refuser_) {
      std::this_thread::yield();
      team_.check();
    }
    refused_ = {};
  }

  Synchronization counts() const {
    Synchronization counts = counts_;
    held_.count_mutexes(counts);
    return counts;
  }

 private:
  struct Link {
    CornerNumber corner, neighbour;
  };
  void count_lists() {
    if (!kCounted) return;
    add_list(counts_.journals, journal_.size());
    add_list(counts_.lock_lists, held_.size());
  }
  // Returns as HeldLeaves::wait().
  std::uint32_t wait_by_priority(NodeNumber node, RecordNumber record) {
    const std::uint64_t own = blocking_.priorities[thread_].load(std::memory_order_relaxed);
    for (;;) {
      const std::uint32_t owner = held_.try_again(node, record);
      if (owner == 0 || owner == kReplaced) return owner;
      if (blocking_.priorities[owner - 1].load(std::memory_order_relaxed) >= own) return owner;
      std::this_thread::yield();
      team_.check();
    }
  }
  void raise_priority() {
    const std::lock_guard guard(blocking_.raising);
    std::uint64_t highest = 0;
    for (const auto& priority : blocking_.priorities) {
      highest = std::max(highest, priority.load(std::memory_order_relaxed));
    }
    blocking_.priorities[thread_].store(highest + 1, std::memory_order_relaxed);
  }

  Dag<D>& dag_;
  parallel::Team& team_;
  Blocking& blocking_;
  std::uint32_t thread_;
  bool priorities_, early_;
  HeldLeaves<D, kPlain> held_;
  HeldLeaf refused_;  // what refuser_ (1 + its number) would not give
  std::uint32_t refuser_ = 0;
  std::vector<Link> journal_;
  Synchronization counts_;
};

}  // namespace delray::delaunay::internal
