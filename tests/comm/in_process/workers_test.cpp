// Nobody lets go of oneTBB's workers by pthread_detach.
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <pthread.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "comm/threads.h"
#include "parallel/arena.h"
#include "parallel/parallel_for.h"
#include "parallel/stack.h"

#if !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)

namespace {
std::atomic<int> detached;
}  // namespace

// In place of glibc's for all of this program, libtbb too, which calls it for each of its workers
// when the last thread that used them ends.
extern "C" int pthread_detach(pthread_t thread) noexcept {
  ++detached;
  using Detach = int (*)(pthread_t);
  static const auto next = reinterpret_cast<Detach>(::dlsym(RTLD_NEXT, "pthread_detach"));
  return next(thread);
}

namespace delray {
namespace {

// Returns when two threads have met in it.
void meet() {
  std::atomic<int> here{0};
  parallel::parallel_for(0, 2, 1, [&](std::size_t) {
    ++here;
    while (here < 2) std::this_thread::yield();
  });
}

TEST(Workers, AreJoinedWhenRanksAndStacksOfTheirOwnEnd) {
  const int before = detached;
  for (int i = 0; i < 3; ++i) {
    comm::run_threads(2, 2, [](comm::Communicator&) { meet(); });
    parallel::run_on_own_stack([] {
      const parallel::AllowThreads allowed(2);
      parallel::Arena(2).execute([] { meet(); });
      return 0;
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // workers linger in an arena
  }
  EXPECT_EQ(detached, before);
}

}  // namespace
}  // namespace delray

#endif
