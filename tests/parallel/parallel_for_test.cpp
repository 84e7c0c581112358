// Loops and reductions do not depend on the number of threads.
#include "parallel/parallel_for.h"

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "parallel/arena.h"
#include "parallel/progress.h"

namespace delray::parallel {
namespace {

TEST(ParallelFor, VisitsEachIndexOnce) {
  for (const std::size_t n : {0UL, 1UL, 7UL, 100000UL}) {
    std::vector<std::atomic<int>> visits(n);
    parallel_for(0, n, 16, [&](std::size_t i) { ++visits[i]; });
    for (const auto& count : visits) EXPECT_EQ(count.load(), 1);
  }
}

TEST(ParallelBlocks, EmptyAndInvertedRangesDoNothing) {
  parallel_blocks(5, 5, 1, [](std::size_t, std::size_t) { FAIL(); });
  parallel_blocks(6, 5, 1, [](std::size_t, std::size_t) { FAIL(); });
}

TEST(ParallelReduce, SumOfFloatsDoesNotDependOnThreads) {
  std::vector<float> values(100003);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = 1.0F / static_cast<float>(i + 1);
  const auto sum = [&] {
    return parallel_reduce(
        0, values.size(), 1000, 0.0F,
        [&](std::size_t first, std::size_t last) {
          return std::accumulate(values.begin() + static_cast<std::ptrdiff_t>(first),
                                 values.begin() + static_cast<std::ptrdiff_t>(last), 0.0F);
        },
        std::plus<>{});
  };
  Arena one(1);
  const float expected = one.execute(sum);
  for (const int threads : {2, 3, 8}) {
    Arena arena(threads);
    for (int repeat = 0; repeat < 20; ++repeat) EXPECT_EQ(arena.execute(sum), expected);
  }
}

TEST(ParallelBlocks, CoverTheRangeOnce) {
  std::vector<int> calls(1000, 0);
  Arena(4).execute([&] {
    parallel_blocks(10, 1000, 7, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) ++calls[i];
    });
  });
  for (std::size_t i = 0; i < calls.size(); ++i) EXPECT_EQ(calls[i], i < 10 ? 0 : 1) << i;
}

TEST(ParallelReduce, CombinesInTheOrderOfTheRange) {
  const std::string letters = "divide and conquer in parallel";
  const auto map = [&](std::size_t first, std::size_t last) {
    return letters.substr(first, last - first);
  };
  EXPECT_EQ(parallel_reduce(0, letters.size(), 4, std::string(), map, std::plus<>{}), letters);
}

TEST(ParallelReduce, OfAnEmptyRangeIsTheIdentity) {
  EXPECT_EQ(parallel_reduce(
                3, 3, 4, 17, [](std::size_t, std::size_t) { return 1; }, std::plus<>{}),
            17);
}

TEST(Arena, GivesItsNumberOfThreads) {
  Arena arena(5);
  EXPECT_EQ(arena.execute([] { return arena_threads(); }), 5);
}

TEST(Arena, HandsOnWhatIsReturnedAndThrown) {
  Arena arena(2);
  EXPECT_EQ(*arena.execute([] { return std::make_unique<int>(3); }), 3);
  EXPECT_THROW(arena.execute([] { throw std::runtime_error("out"); }), std::runtime_error);
}

TEST(Progress, StopsALoop) {
  Progress progress;
  progress.start(1000);
  Arena arena(4);
  EXPECT_THROW(arena.execute([&] {
    parallel_for(0, 1000, 1, [&](std::size_t i) {
      if (i == 17) progress.request_stop();
      progress.advance();
    });
  }),
               Interrupted);
  EXPECT_EQ(progress.total(), 1000U);
}

}  // namespace
}  // namespace delray::parallel
