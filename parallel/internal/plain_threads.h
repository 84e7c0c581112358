// Loops over std::thread instead of oneTBB, for ThreadSanitizer: it sees these threads start and
// join, but not what orders the tasks of a oneTBB that was built without it, and so would report
// races that there are not and overlook others. Threads are made anew for every loop.
#pragma once

#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace delray::parallel::internal {

// Calls f(task) for every task of [0, tasks), the caller's thread among as many as its arena has.
// Rethrows what one of them threw first; tasks that had not begun are then left out.
template <class F>
void run_tasks(std::size_t tasks, F&& f) {
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
  const auto arena = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  std::vector<std::jthread> threads;
  for (std::size_t i = 1; i < std::min(tasks, arena); ++i) threads.emplace_back(work);
  work();
  threads.clear();
  if (error) std::rethrow_exception(error);
}

// Where oneTBB's simple partitioner cuts [begin, end).
inline void cut(std::size_t begin, std::size_t end, std::size_t grain,
                std::vector<std::size_t>& ends) {
  if (end - begin <= grain) return ends.push_back(end);
  const std::size_t middle = begin + (end - begin) / 2;
  cut(begin, middle, grain, ends);
  cut(middle, end, grain, ends);
}

template <class F>
void parallel_blocks(std::size_t begin, std::size_t end, std::size_t grain, F&& f) {
  std::vector<std::size_t> ends = {begin};
  cut(begin, end, grain, ends);
  run_tasks(ends.size() - 1, [&](std::size_t block) { f(ends[block], ends[block + 1]); });
}

// Takes the results of the blocks of [begin, end) from `next` on and combines them as a tree.
template <class T, class Combine>
T combined(std::size_t begin, std::size_t end, std::size_t grain,
           typename std::vector<T>::iterator& next, const Combine& combine) {
  if (end - begin <= grain) return *next++;
  const std::size_t middle = begin + (end - begin) / 2;
  const T lower = combined<T>(begin, middle, grain, next, combine);
  return combine(lower, combined<T>(middle, end, grain, next, combine));
}

template <class T, class Map, class Combine>
T parallel_reduce(std::size_t begin, std::size_t end, std::size_t grain, const T& identity,
                  const Map& map, const Combine& combine) {
  std::vector<std::size_t> ends = {begin};
  cut(begin, end, grain, ends);
  std::vector<T> results(ends.size() - 1, identity);
  run_tasks(results.size(), [&](std::size_t block) {
    results[block] = combine(identity, map(ends[block], ends[block + 1]));
  });
  auto next = results.begin();
  return combined<T>(begin, end, grain, next, combine);
}

}  // namespace delray::parallel::internal
