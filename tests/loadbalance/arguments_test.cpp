// Arguments that cannot be are std::invalid_argument.
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <vector>

#include "comm/threads.h"
#include "loadbalance/balance.h"
#include "loadbalance/partition.h"
#include "loadbalance/schedule.h"
#include "loadbalance/simulated_schedule.h"

namespace delray::loadbalance {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr geometry::Rect kFrame{0, 0, 64, 48};

#define EXPECT_REFUSED(...) EXPECT_THROW((void)(__VA_ARGS__), std::invalid_argument)

TEST(Arguments, OfPartitions) {
  const std::vector<WeightedBox> boxes = {{{0, 0, 10, 10}, 1.0}};
  const Costs costs = make_costs(kFrame, 8, 8, boxes);
  for (const Partitioner& partitioner : partitioners()) {
    SCOPED_TRACE(partitioner.name);
    EXPECT_REFUSED(partitioner.partition(costs, kFrame, 0));
    EXPECT_REFUSED(partitioner.partition(costs, kFrame, -3));
    EXPECT_REFUSED(partitioner.partition(costs, {0, 0, 10, 10}, 2));
    Costs wrong = costs;
    wrong.cells[3] = kNan;
    EXPECT_REFUSED(partitioner.partition(wrong, kFrame, 2));
    wrong = costs;
    wrong.boxes[0].cost = -1;
    EXPECT_REFUSED(partitioner.partition(wrong, kFrame, 2));
    wrong = costs;
    wrong.cells.pop_back();
    EXPECT_REFUSED(partitioner.partition(wrong, kFrame, 2));
    EXPECT_REFUSED(partition_for_ranks(partitioner, costs, 0, 1));
    EXPECT_REFUSED(partition_for_ranks(partitioner, costs, 2, 0));
    EXPECT_REFUSED(report(partitioner, costs, -1, 1));
  }
  const Partition partition = partitioners()[0].partition(costs, kFrame, 4);
  EXPECT_REFUSED(loads(costs, partition, 3));
  EXPECT_REFUSED(balance(partition, boxes, 3));
  EXPECT_REFUSED(balance(partition, boxes, 0));
  EXPECT_REFUSED(assign_largest_first(costs, partition, 0));
}

TEST(Arguments, OfCosts) {
  EXPECT_REFUSED(make_costs(kFrame, 0, 8, {}));
  EXPECT_REFUSED(make_costs(kFrame, 8, -1, {}));
  for (const WeightedBox& wrong :
       {WeightedBox{{0, 0, 9, 9}, kNan}, WeightedBox{{0, 0, 9, 9}, -1.0},
        WeightedBox{{0, 0, 9, 9}, 1.0, 2.0}, WeightedBox{{0, 0, 9, 9}, 1.0, kNan}}) {
    EXPECT_REFUSED(make_costs(kFrame, 8, 8, std::vector<WeightedBox>{wrong}));
  }
  EXPECT_REFUSED(cost_cell_side(kFrame, 0));
  EXPECT_REFUSED(primitives_per_box(100, 0));
  EXPECT_REFUSED(Blocks{kFrame, 0, 8}.grid());
}

TEST(Arguments, OfSchedules) {
  const TaskGrid grid{4, 4};
  const std::vector<double> few(3), enough(16);
  const std::vector<std::uint64_t> few_bytes(3);
  for (const Schedule& schedule : schedules()) {
    SCOPED_TRACE(schedule.name);
    std::vector<ScheduleOptions> options(4);
    options[0].threads = -3;
    options[1].threads = 100000;
    options[2].share = kNan;
    options[3].fan_out = 0;
    for (const ScheduleOptions& wrong : options) {
      EXPECT_REFUSED(comm::run_threads(2, 1, [&](comm::Communicator& communicator) {
        schedule.run(communicator, grid, wrong, [](std::uint32_t, int) {});
      }));
    }
    EXPECT_REFUSED((simulate(schedule, {grid, few}, 2, {})));
    EXPECT_REFUSED((simulate(schedule, {grid, enough, few_bytes}, 2, {})));
    EXPECT_REFUSED((simulate(schedule, {grid, enough}, 0, {})));
  }
  ScheduleOptions beyond;
  beyond.initial = {{0, 100}};
  for (const char* name : {"static", "stealing", "neighbour-stealing"}) {
    EXPECT_REFUSED(comm::run_threads(2, 1, [&](comm::Communicator& communicator) {
      find_schedule(name)->run(communicator, grid, beyond, [](std::uint32_t, int) {});
    }));
  }
}

}  // namespace
}  // namespace delray::loadbalance
