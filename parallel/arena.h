// The set of threads that a rank computes with.
#pragma once

#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

#include "parallel/function_ref.h"

namespace delray::parallel {

// Runs parallel loops with at most `threads` threads, the caller among them. An arena belongs to
// one rank; code that is called without one runs in the arena that its caller is in.
class Arena {
 public:
  // REQUIRES: threads >= 1.
  explicit Arena(int threads);
  ~Arena();
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  // What f() returns, or throws, when called inside the arena.
  template <class F>
  auto execute(F&& f) -> std::invoke_result_t<F> {
    using Result = std::invoke_result_t<F>;
    static_assert(!std::is_reference_v<Result>);
    if constexpr (std::is_void_v<Result>) {
      run(f);
    } else {
      std::optional<Result> result;
      run([&] { result.emplace(f()); });
      return std::move(*result);
    }
  }

 private:
  void run(FunctionRef<void()> f);

  struct Threads;
  std::unique_ptr<Threads> threads_;
};

// While it lives, oneTBB may run as many as `threads` workers in this process, and no fewer than
// there are cores: without it arenas of more threads than cores get no more than the cores. Of
// several the least counts, so whoever starts all ranks makes one for all of them.
class AllowThreads {
 public:
  explicit AllowThreads(int threads);
  ~AllowThreads();
  AllowThreads(const AllowThreads&) = delete;
  AllowThreads& operator=(const AllowThreads&) = delete;

 private:
  struct Limit;
  std::unique_ptr<Limit> limit_;
};

// Whoever starts threads that run loops, and waits for them, has one around that: at its end
// oneTBB's workers are joined, unless the caller or somebody else in the process uses them. Without
// it the last of those threads lets go of them by pthread_detach, which crashes now and then: in
// glibc 2.36 it reads the stack of a worker that may have gone (oneTBB's issue 1758).
class JoinWorkers {
 public:
  JoinWorkers();
  ~JoinWorkers();
  JoinWorkers(const JoinWorkers&) = delete;
  JoinWorkers& operator=(const JoinWorkers&) = delete;

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
};

// The number of threads of the arena that the caller is in.
int arena_threads();
// The number of the calling thread in that arena, from 0 to arena_threads() - 1.
int arena_thread();

}  // namespace delray::parallel
