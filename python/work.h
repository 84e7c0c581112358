// Work of the libraries called from Python: without the interpreter's lock, with a number of
// threads, and so that Ctrl-C ends it.
#pragma once

#include <pybind11/pybind11.h>

#include <optional>
#include <utility>

#include "parallel/function_ref.h"
#include "parallel/progress.h"

namespace delray::python {

// How a piece of work runs.
struct Work {
  int threads = 1;  // at least 1
  // Whether it may take long: then it runs on a thread of its own, while the caller's looks for
  // signals, which Python hands to its main thread alone. Without, on the caller's.
  bool is_long = false;
  // Asked to stop instead of one of its own, if not null.
  parallel::Progress* progress = nullptr;
};

namespace internal {
void run(const Work& work, parallel::FunctionRef<void(parallel::Progress&)> f);
}

// The number of threads that an argument asks for; none stands for all cores. Throws
// std::invalid_argument for less than one or more than the libraries take.
int thread_count(std::optional<int> threads);

// What f(progress) returns or throws; it must not touch Python. On Ctrl-C, or whatever exception a
// signal handler of Python raises, `progress` is asked to stop, and that exception leaves once f
// has ended. REQUIRES: the caller has the interpreter's lock.
template <class F>
auto run(const Work& work, F&& f) {
  using Result = decltype(f(std::declval<parallel::Progress&>()));
  if constexpr (std::is_void_v<Result>) {
    internal::run(work, f);
  } else {
    std::optional<Result> result;
    internal::run(work, [&](parallel::Progress& progress) { result.emplace(f(progress)); });
    return std::move(*result);
  }
}

}  // namespace delray::python
