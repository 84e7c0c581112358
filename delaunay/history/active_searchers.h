// How many threads of the batch method locate points for the one that inserts them.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "delaunay/triangulate.h"
#include "parallel/team.h"

namespace delray::delaunay::internal {

// Nobody waits where locating a point takes as many times as long as inserting it as there are
// threads that locate: round(locate / insert) of them, at least one, at most `most` (Kohout 2004,
// 7.8.1). `present` stays where the ratio is hardly nearer to another number, so that noise of the
// clock does not send threads to sleep and wake them by turns. Times are of one point.
//
// REQUIRES: locate > 0, insert > 0, 1 <= present <= most.
inline int searching_threads(double locate, double insert, int present, int most) {
  constexpr double kHardly = 0.25;  // of a thread
  const double ratio = std::min(locate / insert, static_cast<double>(most));
  if (std::abs(ratio - present) <= 0.5 + kHardly) return present;
  return std::max(static_cast<int>(std::lround(ratio)), 1);
}

// The first active() of the threads locate points, the others sleep. The inserting thread chooses
// anew, by the times since the last choice, for the history grows deeper and locating takes longer.
class ActiveSearchers {
 public:
  // `fixed`: all are active to the end. Otherwise two to begin with, as the report has them for the
  // fewest points.
  ActiveSearchers(int threads, bool fixed)
      : threads_(threads),
        fixed_(fixed || threads == 1),
        active_(fixed ? threads : std::min(threads, 2)) {
    choices_.push_back({0, active_.load(std::memory_order_relaxed)});
  }

  bool fixed() const { return fixed_; }
  std::size_t active() const {
    return static_cast<std::size_t>(active_.load(std::memory_order_relaxed));
  }
  // Returns when the searching thread of this number is active. Errors: parallel::TeamStopped.
  void wait(std::size_t thread, const parallel::Team& team) {
    // A team that fails before it has an inserting thread wakes nobody.
    constexpr std::chrono::milliseconds kPatience(100);
    if (thread < active()) return;
    std::unique_lock lock(choosing_);
    while (thread >= active()) {
      team.check();
      chosen_.wait_for(lock, kPatience);
    }
  }

  // Points that a searching thread has located, in so much of its processor's time. Any thread.
  void located(std::size_t points, std::int64_t nanoseconds) {
    located_points_.fetch_add(points, std::memory_order_relaxed);
    located_time_.fetch_add(nanoseconds, std::memory_order_relaxed);
  }

  // For the inserting thread. Points that it has taken from queues and inserted likewise.
  void inserted(std::size_t points, std::int64_t nanoseconds) {
    inserted_points_ += points;
    inserted_time_ += nanoseconds;
  }
  // Chooses if there are enough times since the last choice; `inserted` points are in.
  void choose(std::uint64_t inserted) {
    // Enough for the mean of some microseconds each to hold still.
    constexpr std::size_t kFew = 128;
    const std::size_t points = located_points_.load(std::memory_order_relaxed);
    const std::int64_t time = located_time_.load(std::memory_order_relaxed);
    if (fixed_ || points < kFew || inserted_points_ < kFew || time <= 0 || inserted_time_ <= 0) {
      return;
    }
    const int chosen = searching_threads(
        static_cast<double>(time) / static_cast<double>(points),
        static_cast<double>(inserted_time_) / static_cast<double>(inserted_points_),
        choices_.back().threads, threads_);
    // What others add meanwhile counts for the next choice.
    located_points_.fetch_sub(points, std::memory_order_relaxed);
    located_time_.fetch_sub(time, std::memory_order_relaxed);
    inserted_points_ = 0;
    inserted_time_ = 0;
    if (chosen == choices_.back().threads) return;
    choices_.push_back({inserted, chosen});
    set(chosen);
  }
  // Lets all run to their ends.
  void wake_all() { set(threads_); }
  const std::vector<SearchingThreads>& choices() const { return choices_; }

 private:
  void set(int active) {
    {
      const std::lock_guard lock(choosing_);
      active_.store(active, std::memory_order_relaxed);
    }
    chosen_.notify_all();
  }

  int threads_;
  bool fixed_;
  std::atomic<int> active_;
  std::mutex choosing_;
  std::condition_variable chosen_;
  std::atomic<std::size_t> located_points_ = 0;
  std::atomic<std::int64_t> located_time_ = 0;
  std::size_t inserted_points_ = 0;
  std::int64_t inserted_time_ = 0;
  std::vector<SearchingThreads> choices_;
};

}  // namespace delray::delaunay::internal
