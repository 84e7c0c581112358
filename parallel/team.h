// Threads that wait for each other.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace delray::parallel {

// Thrown to the threads of a team where they would wait or begin something new after another
// failed.
struct TeamStopped {};

// Runs as many threads as asked for at the same time, whatever the number of cores: a pool
// promises no concurrency, and so a thread of a pool must not wait for another.
class Team {
 public:
  // Throws TeamStopped if another thread has failed.
  void check() const {
    if (stopping_.load(std::memory_order_relaxed)) throw TeamStopped{};
  }

  // Calls work(0) .. work(threads - 1), work(0) on the calling thread. Errors: the first exception
  // that left a call, after all have ended. REQUIRES: threads >= 1.
  template <class F>
  void run(std::size_t threads, F&& work) {
    const auto guarded = [&](std::size_t thread) {
      try {
        work(thread);
      } catch (const TeamStopped&) {
      } catch (...) {
        fail(std::current_exception());
      }
    };
    {
      std::vector<std::jthread> others;
      try {
        others.reserve(threads - 1);
        for (std::size_t thread = 1; thread < threads; ++thread) {
          others.emplace_back(guarded, thread);
        }
      } catch (...) {
        fail(std::current_exception());
      }
      if (others.size() + 1 == threads) guarded(0);
    }
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
  }

 private:
  void fail(std::exception_ptr failure) {
    const std::lock_guard guard(failing_);
    if (!failure_) failure_ = std::move(failure);
    stopping_.store(true, std::memory_order_relaxed);
  }

  std::atomic<bool> stopping_{false};
  std::mutex failing_;
  std::exception_ptr failure_;
};

}  // namespace delray::parallel
