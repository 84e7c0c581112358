// Arenas are oneTBB task arenas with one place kept for the caller; AllowThreads is a
// global_control of oneTBB.
#include "parallel/arena.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <new>

#include "parallel/stack.h"

namespace delray::parallel {

#ifdef DELRAY_TSAN
namespace {
// Loops run on plain threads; what libraries do in oneTBB's tasks, as Embree does, stays on the
// thread that waits for it. ThreadSanitizer sees nothing of what orders the tasks of several.
const tbb::global_control no_workers(tbb::global_control::max_allowed_parallelism, 1);
}  // namespace
#endif

struct Arena::Threads {
  tbb::task_arena arena;
};

Arena::Arena(int threads) : threads_(new Threads{tbb::task_arena(threads, 1)}) {
  set_worker_stack_size();
}
Arena::~Arena() = default;
void Arena::run(FunctionRef<void()> f) { threads_->arena.execute(f); }

struct AllowThreads::Limit {
  tbb::global_control control;
};

AllowThreads::AllowThreads(int threads)
    : limit_(new Limit{tbb::global_control(
          tbb::global_control::max_allowed_parallelism,
          static_cast<std::size_t>(std::max(threads, tbb::info::default_concurrency())))}) {}
AllowThreads::~AllowThreads() = default;

struct JoinWorkers::Handle {
  tbb::task_scheduler_handle handle;
};

JoinWorkers::JoinWorkers() {
  set_worker_stack_size();
  handle_.reset(new Handle{tbb::attach()});
}
JoinWorkers::~JoinWorkers() {
  // A thread that has used oneTBB itself keeps the workers to its end, and may be inside of an
  // arena now, which finalize() would pull away from under it.
  const bool uses_them =
      tbb::this_task_arena::current_thread_index() != tbb::task_arena::not_initialized;
  if (!uses_them) tbb::finalize(handle_->handle, std::nothrow);
}

int arena_threads() { return tbb::this_task_arena::max_concurrency(); }
int arena_thread() { return std::max(0, tbb::this_task_arena::current_thread_index()); }

}  // namespace delray::parallel
