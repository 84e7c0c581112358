// Every point goes to one thread, and idle threads take over.
#include "delaunay/insertion/point_supply.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

#include "parallel/team.h"

namespace delray::delaunay::internal {
namespace {

TEST(PointSupply, GivesAThreadItsOwnPartInOrder) {
  PointSupply supply(1);
  supply.set(0, 10, 110);
  std::vector<VertexNumber> points;
  supply.for_each(0, [&](VertexNumber vertex) { points.push_back(vertex); });
  ASSERT_EQ(points.size(), 100U);
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(points[i], 10 + i);
}

TEST(PointSupply, GivesWhatOthersLeaveToIdleThreads) {
  PointSupply supply(3);
  supply.set(0, 0, 1000);
  supply.set(1, 1000, 1000);
  supply.set(2, 1000, 1001);
  // The later half comes first, since the thread has nothing of its own.
  std::vector<int> times(1001, 0);
  VertexNumber first = 0;
  bool any = false;
  supply.for_each(1, [&](VertexNumber vertex) {
    if (!any) first = vertex;
    any = true;
    ++times[vertex];
  });
  EXPECT_EQ(first, 500U);
  for (const int count : times) EXPECT_EQ(count, 1);
}

TEST(PointSupply, GivesEveryPointToOneThread) {
  constexpr std::size_t kThreads = 8, kPoints = 20000;
  for (int repetition = 0; repetition < 10; ++repetition) {
    PointSupply supply(kThreads);
    for (std::size_t part = 0; part < kThreads; ++part) {
      // Parts of very different sizes.
      supply.set(part, kPoints * part * part / 64, kPoints * (part + 1) * (part + 1) / 64);
    }
    std::vector<std::atomic<int>> times(kPoints);
    parallel::Team team;
    team.run(kThreads, [&](std::size_t thread) {
      supply.for_each(thread, [&](VertexNumber vertex) { ++times[vertex]; });
    });
    for (const auto& count : times) ASSERT_EQ(count.load(), 1);
  }
}

}  // namespace
}  // namespace delray::delaunay::internal
