// Teams: all threads run at once, and the first failure ends the run.
#include "parallel/team.h"

#include <gtest/gtest.h>

#include <atomic>
#include <barrier>
#include <stdexcept>
#include <thread>
#include <vector>

namespace delray::parallel {
namespace {

TEST(Team, RunsAllThreadsAtOnce) {
  for (const std::size_t threads : {1, 2, 7}) {
    std::vector<int> calls(threads);
    std::barrier all(static_cast<std::ptrdiff_t>(threads));
    const auto caller = std::this_thread::get_id();
    Team().run(threads, [&](std::size_t thread) {
      all.arrive_and_wait();  // nobody would come past it without all others
      ++calls[thread];
      EXPECT_EQ(std::this_thread::get_id() == caller, thread == 0);
    });
    EXPECT_EQ(calls, std::vector<int>(threads, 1));
  }
}

TEST(Team, FailureStopsThreadsThatCheckAndIsRethrown) {
  for (const std::size_t failing : {0, 2}) {
    Team team;
    EXPECT_THROW(team.run(4,
                          [&](std::size_t thread) {
                            if (thread == failing) throw std::out_of_range("one");
                            for (;;) team.check();
                          }),
                 std::out_of_range);
  }
}

}  // namespace
}  // namespace delray::parallel
