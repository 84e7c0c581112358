// How many threads of the batch method locate points: the choice, and runs that make it.
#include "delaunay/history/active_searchers.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "delaunay/generate.h"
#include "tests/delaunay/same_simplices.h"

namespace delray::delaunay {
namespace {

using internal::ActiveSearchers;
using internal::searching_threads;

constexpr std::uint64_t kBatchSeed = 20261128;

TEST(SearchingThreads, AreTheRoundedRatioOfTimes) {
  EXPECT_EQ(searching_threads(3.0, 1.0, 1, 7), 3);
  EXPECT_EQ(searching_threads(3.4, 1.0, 1, 7), 3);
  EXPECT_EQ(searching_threads(0.9, 0.3, 1, 7), 3);
  EXPECT_EQ(searching_threads(3.6, 1.0, 1, 7), 4);
  EXPECT_EQ(searching_threads(1.0, 1.0, 5, 7), 1);
}

TEST(SearchingThreads, AreAtLeastOneAndAtMostAsManyAsThereAre) {
  EXPECT_EQ(searching_threads(1e-9, 1.0, 3, 7), 1);
  EXPECT_EQ(searching_threads(100.0, 1.0, 1, 7), 7);
  EXPECT_EQ(searching_threads(100.0, 1.0, 1, 1), 1);
  EXPECT_EQ(searching_threads(1e300, 1e-300, 1, 3), 3);
}

TEST(SearchingThreads, StayWhereTheRatioHardlyLeavesThem) {
  EXPECT_EQ(searching_threads(2.7, 1.0, 2, 7), 2);
  EXPECT_EQ(searching_threads(2.7, 1.0, 3, 7), 3);
  EXPECT_EQ(searching_threads(2.8, 1.0, 2, 7), 3);
  EXPECT_EQ(searching_threads(2.2, 1.0, 3, 7), 2);
  EXPECT_EQ(searching_threads(2.3, 1.0, 3, 7), 3);
}

TEST(ActiveSearchers, FollowTheTimesOfTheLastPoints) {
  ActiveSearchers searchers(7, false);
  EXPECT_EQ(searchers.active(), 2U);
  searchers.choose(100);  // nothing was measured
  EXPECT_EQ(searchers.active(), 2U);
  searchers.located(1000, 4'000'000);
  searchers.choose(200);  // no insertion was
  EXPECT_EQ(searchers.active(), 2U);
  searchers.inserted(500, 500'000);
  searchers.choose(300);  // 4000 ns against 1000
  EXPECT_EQ(searchers.active(), 4U);
  searchers.located(1000, 4'000'000);
  searchers.inserted(1000, 1'000'000);
  searchers.choose(400);
  searchers.located(1000, 1'000'000);
  searchers.inserted(1000, 1'000'000);
  searchers.choose(500);  // what was before counts no more
  const std::vector<SearchingThreads> expected = {{0, 2}, {300, 4}, {500, 1}};
  EXPECT_EQ(searchers.choices(), expected);
}

TEST(ActiveSearchers, StayAsToldWhereTheirNumberIsGiven) {
  ActiveSearchers searchers(3, true);
  searchers.located(1000, 1'000'000);
  searchers.inserted(1000, 9'000'000);
  searchers.choose(1000);
  EXPECT_EQ(searchers.active(), 3U);
  EXPECT_EQ(searchers.choices(), (std::vector<SearchingThreads>{{0, 3}}));
  EXPECT_EQ(ActiveSearchers(1, false).active(), 1U);
}

TEST(ActiveSearchers, OthersSleepUntilTheyAreChosenOrTheTeamFails) {
  ActiveSearchers searchers(5, false);
  std::atomic<int> through = 0;
  parallel::Team team;
  team.run(6, [&](std::size_t thread) {
    if (thread < 5) {
      searchers.wait(thread, team);
      ++through;
      return;
    }
    while (through < 2) std::this_thread::yield();
    EXPECT_EQ(through, 2);
    searchers.wake_all();
  });
  EXPECT_EQ(through, 5);
  ActiveSearchers forgotten(5, false);
  EXPECT_THROW(team.run(5,
                        [&](std::size_t thread) {
                          if (thread == 0) throw std::runtime_error("failed");
                          forgotten.wait(thread, team);
                        }),
               std::runtime_error);
}

// Whatever is chosen: parts of threads that sleep are done by others.
TEST(Batch, MakesTheSameSimplicesWithChosenAndWithGivenThreads) {
  for (const char* const kind : {"uniform", "grid", "cluster"}) {
    const auto points = generate_points(kind, 10'000, 2, kBatchSeed).positions;
    const Triangulation expected = expected_of(points, 2);
    for (const std::string split : {"random", "slabs", "distance", "curve"}) {
      for (const int searching : {0, 1, 2, 6}) {
        Options options;
        options.method = "batch";
        options.split = split;
        options.searching = searching;
        options.threads = 7;
        options.seed = kBatchSeed;
        ASSERT_NO_FATAL_FAILURE(expect_same(points, expected, options, kind));
      }
    }
  }
}

TEST(Batch, TellsItsSearchingThreads) {
  const auto points = generate_points("uniform", 20'000, 2, kBatchSeed).positions;
  Options options;
  options.method = "batch";
  options.threads = 7;
  options.statistics = true;
  const auto chosen = triangulate(view(points), options).statistics.searching;
  ASSERT_FALSE(chosen.empty());
  EXPECT_EQ(chosen.front(), (SearchingThreads{0, 2}));
  for (std::size_t i = 1; i < chosen.size(); ++i) {
    EXPECT_GT(chosen[i].inserted, chosen[i - 1].inserted);
    EXPECT_NE(chosen[i].threads, chosen[i - 1].threads);
    EXPECT_GE(chosen[i].threads, 1);
    EXPECT_LE(chosen[i].threads, 6);
  }
  options.searching = 4;
  EXPECT_EQ(triangulate(view(points), options).statistics.searching,
            (std::vector<SearchingThreads>{{0, 4}}));
  options.threads = 4;
  EXPECT_THROW(triangulate(view(points), options), std::invalid_argument);
  options.searching = 0;
  options.threads = 1;
  EXPECT_TRUE(triangulate(view(points), options).statistics.searching.empty());
}

}  // namespace
}  // namespace delray::delaunay
