// Schedules on the simulated machine.
#include "loadbalance/simulated_schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace delray::loadbalance {
namespace {

// Costly tasks come last, all in a row.
std::vector<double> uneven(std::uint32_t count) {
  std::vector<double> seconds(count, 1e-3);
  for (std::uint32_t i = count - count / 8; i < count; ++i) seconds[i] = 8e-3;
  return seconds;
}

TEST(SimulatedSchedule, DoesEveryTaskOnceInItsTime) {
  const TaskGrid grid{20, 10};
  const std::vector<double> seconds = uneven(grid.count());
  const double all = std::accumulate(seconds.begin(), seconds.end(), 0.0);
  for (const Schedule& schedule : schedules()) {
    for (const int ranks : {1, 3, 8, 60}) {
      SCOPED_TRACE(std::string(schedule.name) + " " + std::to_string(ranks));
      const SimulatedSchedule run = simulate(schedule, {grid, seconds}, ranks, {});
      ASSERT_EQ(run.ranks.size(), static_cast<std::size_t>(ranks));
      std::vector<std::uint64_t> tasks(ranks);
      std::vector<double> busy(ranks);
      for (std::uint32_t task = 0; task < grid.count(); ++task) {
        ASSERT_TRUE(run.owners[task] >= 0 && run.owners[task] < ranks);
        ++tasks[run.owners[task]];
        busy[run.owners[task]] += seconds[task];
      }
      for (int rank = 0; rank < ranks; ++rank) {
        EXPECT_EQ(run.ranks[rank].tasks, tasks[rank]);
        // Looking for messages between two tasks takes time, too.
        EXPECT_GE(run.ranks[rank].busy, busy[rank] - 1e-9);
        EXPECT_LE(run.ranks[rank].busy, 1.01 * busy[rank] + 1e-4);
      }
      EXPECT_GE(run.seconds, std::max(all / ranks, 8e-3) - 1e-6);
      EXPECT_LE(run.seconds, all + 0.01);
    }
  }
}

TEST(SimulatedSchedule, GathersResultsOnRankZero) {
  const std::vector<double> seconds(4, 1.0);
  const std::vector<std::uint64_t> bytes(4, 8);
  comm::Network network;
  network.latency = 0.5;
  network.overhead = 0;
  network.seconds_per_byte = 1;
  const SimulatedTasks tasks{{4, 1}, seconds, bytes, 4, 0.25};
  const SimulatedSchedule run = simulate(*find_schedule("static"), tasks, 2, network);
  EXPECT_NEAR(run.seconds, 2, 1e-3);
  // Rank 1 packs 16 bytes, 20 travel, and rank 0 unpacks 16.
  EXPECT_NEAR(run.frame_seconds, 2 + 4 + 20.5 + 4, 1e-3);
  EXPECT_NEAR(simulate(*find_schedule("static"), {{4, 1}, seconds}, 2, network).frame_seconds, 2,
              1e-3);
}

TEST(SimulatedSchedule, ShowsThatTakingWorkFromOthersPays) {
  const TaskGrid grid{40, 20};
  const std::vector<double> seconds = uneven(grid.count());
  const auto seconds_with = [&](const char* name) {
    return simulate(*find_schedule(name), {grid, seconds}, 8, {}).seconds;
  };
  EXPECT_LT(seconds_with("stealing"), 0.4 * seconds_with("static"));
  EXPECT_LT(seconds_with("demand"), 0.4 * seconds_with("static"));
}

}  // namespace
}  // namespace delray::loadbalance
