// The caller's thread waits without the interpreter's lock and takes it twenty times a second to
// look for signals.
#include "python/work.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>

#include "delaunay/triangulate.h"
#include "parallel/arena.h"

namespace py = pybind11;

namespace delray::python {
namespace {

constexpr std::chrono::milliseconds kBetweenLooks{50};

void run_in_arena(int threads, parallel::Progress& progress,
                  parallel::FunctionRef<void(parallel::Progress&)> f) {
  const parallel::AllowThreads allowed(threads);
  parallel::Arena arena(threads);
  arena.execute([&] { f(progress); });
}

}  // namespace

int thread_count(std::optional<int> threads) {
  if (!threads) return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  if (*threads < 1 || *threads > delaunay::kMostThreads) {
    throw std::invalid_argument("threads: " + std::to_string(*threads) + " is not from 1 to " +
                                std::to_string(delaunay::kMostThreads));
  }
  return *threads;
}

void internal::run(const Work& work, parallel::FunctionRef<void(parallel::Progress&)> f) {
  parallel::Progress own;
  parallel::Progress& progress = work.progress != nullptr ? *work.progress : own;
  if (!work.is_long) {
    const py::gil_scoped_release unlocked;
    run_in_arena(work.threads, progress, f);
    return;
  }
  std::mutex mutex;
  std::condition_variable ended;
  bool is_done = false;
  std::exception_ptr failed;
  bool interrupted = false;
  {
    const py::gil_scoped_release unlocked;
    const parallel::JoinWorkers join_workers;
    std::jthread worker([&] {
      try {
        run_in_arena(work.threads, progress, f);
      } catch (...) {
        failed = std::current_exception();
      }
      const std::scoped_lock lock(mutex);
      is_done = true;
      ended.notify_one();
    });
    std::unique_lock lock(mutex);
    while (!ended.wait_for(lock, kBetweenLooks, [&] { return is_done; })) {
      if (interrupted) continue;
      lock.unlock();
      {
        const py::gil_scoped_acquire locked;
        interrupted = PyErr_CheckSignals() != 0;
      }
      if (interrupted) progress.request_stop();
      lock.lock();
    }
  }
  if (interrupted) throw py::error_already_set();
  if (failed) std::rethrow_exception(failed);
}

}  // namespace delray::python
