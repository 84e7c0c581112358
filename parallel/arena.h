// The set of threads that a rank computes with.
#pragma once

#include <tbb/task_arena.h>

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

// The number of threads of the arena that the caller is in.
inline int arena_threads() { return tbb::this_task_arena::max_concurrency(); }

}  // namespace delray::parallel
