// How long work tells how far it is and learns that it should stop.
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>

namespace delray::parallel {

// Thrown by Progress::advance once a stop was requested; leaves every result unmade.
struct Interrupted : std::exception {
  const char* what() const noexcept override { return "interrupted"; }
};

// A counter of finished steps that any number of threads advance and one observer reads.
class Progress {
 public:
  Progress() = default;
  // Of a part of a larger task, counted for itself: it is asked to stop when the whole is. `whole`
  // may be null and outlives the part.
  explicit Progress(const Progress* whole) : whole_(whole) {}

  // Starts a task of `steps` steps; 0 when unknown.
  void start(std::uint64_t steps) {
    done_.store(0, std::memory_order_relaxed);
    total_.store(steps, std::memory_order_relaxed);
  }
  // Corrects how many steps the task has.
  void expect(std::uint64_t steps) { total_.store(steps, std::memory_order_relaxed); }
  // Throws Interrupted if a stop was requested.
  void advance(std::uint64_t steps = 1) {
    done_.fetch_add(steps, std::memory_order_relaxed);
    if (stop_requested()) throw Interrupted{};
  }
  // May be called from a signal handler.
  void request_stop() { stop_.store(true, std::memory_order_relaxed); }
  bool stop_requested() const {
    return stop_.load(std::memory_order_relaxed) || (whole_ != nullptr && whole_->stop_requested());
  }

  std::uint64_t done() const { return done_.load(std::memory_order_relaxed); }
  std::uint64_t total() const { return total_.load(std::memory_order_relaxed); }

 private:
  const Progress* whole_ = nullptr;
  std::atomic<std::uint64_t> done_{0}, total_{0};
  std::atomic<bool> stop_{false};
};

}  // namespace delray::parallel
