// Plain threads run each task once.
#include "parallel/threads/plain_threads.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "parallel/arena.h"

namespace delray::parallel {
namespace {

TEST(PlainThreads, RunEachTaskOnce) {
  Arena(4).execute([] {
    std::vector<int> calls(1000, 0);
    internal::run_on_plain_threads(calls.size(), [&](std::size_t task) { ++calls[task]; });
    EXPECT_EQ(calls, std::vector<int>(1000, 1));
  });
}

TEST(PlainThreads, HandOnWhatATaskThrows) {
  Arena(3).execute([] {
    EXPECT_THROW(internal::run_on_plain_threads(50,
                                                [](std::size_t task) {
                                                  if (task == 20) throw std::runtime_error("20");
                                                }),
                 std::runtime_error);
  });
}

}  // namespace
}  // namespace delray::parallel
