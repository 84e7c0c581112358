#include "parallel/internal/plain_threads.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "parallel/arena.h"

namespace delray::parallel {
namespace {

TEST(PlainThreads, BlocksCoverTheRangeOnce) {
  Arena(4).execute([] {
    std::vector<int> calls(1000, 0);
    internal::parallel_blocks(10, 1000, 7, [&](std::size_t first, std::size_t last) {
      EXPECT_LE(last - first, 7U);
      for (std::size_t i = first; i < last; ++i) ++calls[i];
    });
    EXPECT_EQ(std::count(calls.begin(), calls.begin() + 10, 0), 10);
    EXPECT_EQ(std::count(calls.begin() + 10, calls.end(), 1), 990);
  });
}

TEST(PlainThreads, ReducesInTheOrderOfTheRange) {
  Arena(3).execute([] {
    const std::string letters = "divide and conquer in parallel";
    const auto map = [&](std::size_t first, std::size_t last) {
      return letters.substr(first, last - first);
    };
    EXPECT_EQ(internal::parallel_reduce(0, letters.size(), 4, std::string(), map,
                                        [](const auto& a, const auto& b) { return a + b; }),
              letters);
  });
}

TEST(PlainThreads, HandOnWhatATaskThrows) {
  Arena(3).execute([] {
    EXPECT_THROW(internal::run_tasks(50,
                                     [](std::size_t task) {
                                       if (task == 20) throw std::runtime_error("20");
                                     }),
                 std::runtime_error);
  });
}

}  // namespace
}  // namespace delray::parallel
