// What threads enter one at a time: by a mutex of the operating system, or by an atomic flag.
#pragma once

#include <atomic>
#include <mutex>
#include <thread>

namespace delray::delaunay::internal {

// For std::unique_lock. Whoever waits for the mutex is put to sleep by the system; whoever waits
// for the flag yields until it is free (Kohout 2004, 7.7.1).
class CriticalSection {
 public:
  explicit CriticalSection(bool by_mutex) : by_mutex_(by_mutex) {}

  bool try_lock() {
    return by_mutex_ ? mutex_.try_lock() : !taken_.exchange(true, std::memory_order_acquire);
  }
  void lock() {
    if (by_mutex_) return mutex_.lock();
    while (!try_lock()) {
      while (taken_.load(std::memory_order_relaxed)) std::this_thread::yield();
    }
  }
  void unlock() {
    if (by_mutex_) return mutex_.unlock();
    taken_.store(false, std::memory_order_release);
  }

 private:
  bool by_mutex_;
  std::mutex mutex_;
  std::atomic<bool> taken_ = false;
};

}  // namespace delray::delaunay::internal
