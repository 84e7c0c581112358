// Threads get their stacks from attributes instead of from RLIMIT_STACK.
#include "parallel/stack.h"

#include <pthread.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <system_error>
#include <thread>

#include "parallel/arena.h"

namespace delray::parallel {
namespace {

// What threads have that say nothing else; at first the soft limit, or 2 MiB where that is none.
std::size_t default_stack_size() {
  pthread_attr_t attributes;
  std::size_t size = 0;
  if (::pthread_getattr_default_np(&attributes) != 0) return 0;
  ::pthread_attr_getstacksize(&attributes, &size);
  ::pthread_attr_destroy(&attributes);
  return size;
}

}  // namespace

void set_worker_stack_size() {
  static const tbb::global_control control(tbb::global_control::thread_stack_size,
                                           std::max(kStackBytes, default_stack_size()));
}

void set_stack_sizes() {
  set_worker_stack_size();
  if (default_stack_size() >= kStackBytes) return;
  pthread_attr_t attributes;
  if (::pthread_getattr_default_np(&attributes) != 0) return;
  ::pthread_attr_setstacksize(&attributes, kStackBytes);
  ::pthread_setattr_default_np(&attributes);
  ::pthread_attr_destroy(&attributes);
}

int run_on_own_stack(FunctionRef<int()> f) {
  set_stack_sizes();
  const JoinWorkers join_workers;
  int result = 0;
  std::thread thread;
  try {
    thread = std::thread([&] { result = f(); });
  } catch (const std::system_error&) {  // no more threads: what there is has to do
    return f();
  }
  thread.join();
  return result;
}

}  // namespace delray::parallel
