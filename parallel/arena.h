// The set of threads that a rank computes with.
#pragma once

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <utility>

namespace delray::parallel {

// Runs parallel loops with at most `threads` threads, the caller among them. An arena belongs to
// one rank; code that is called without one runs in the arena that its caller is in.
class Arena {
 public:
  // REQUIRES: threads >= 1.
  explicit Arena(int threads) : arena_(threads, 1) {}

  template <class F>
  decltype(auto) execute(F&& f) {
    return arena_.execute(std::forward<F>(f));
  }

 private:
  tbb::task_arena arena_;
};

// While it lives, oneTBB may run as many as `threads` workers in this process, and no fewer than
// there are cores: without it arenas of more threads than cores get no more than the cores. Of
// several the least counts, so whoever starts all ranks makes one for all of them.
class AllowThreads {
 public:
  explicit AllowThreads(int threads)
      : control_(tbb::global_control::max_allowed_parallelism,
                 static_cast<std::size_t>(std::max(threads, tbb::info::default_concurrency()))) {}

 private:
  tbb::global_control control_;
};

// The number of threads of the arena that the caller is in.
inline int arena_threads() { return tbb::this_task_arena::max_concurrency(); }

}  // namespace delray::parallel
