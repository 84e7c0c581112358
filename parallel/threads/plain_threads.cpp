// Threads take task numbers from an atomic counter until none are left or one has thrown.
#include "parallel/threads/plain_threads.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "parallel/arena.h"

namespace delray::parallel::internal {

void run_on_plain_threads(std::size_t tasks, FunctionRef<void(std::size_t)> f) {
  // Relaxed, so that counting orders nothing that the tasks do.
  std::atomic<std::size_t> next = 0;
  std::exception_ptr error;
  std::mutex error_mutex;
  const auto work = [&] {
    try {
      for (std::size_t task; (task = next.fetch_add(1, std::memory_order_relaxed)) < tasks;) {
        f(task);
      }
    } catch (...) {
      next.store(tasks, std::memory_order_relaxed);
      const std::lock_guard lock(error_mutex);
      if (!error) error = std::current_exception();
    }
  };
  std::vector<std::jthread> threads;
  for (std::size_t i = 1; i < std::min(tasks, static_cast<std::size_t>(arena_threads())); ++i) {
    threads.emplace_back(work);
  }
  work();
  threads.clear();
  if (error) std::rethrow_exception(error);
}

}  // namespace delray::parallel::internal
