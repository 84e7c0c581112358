// Ranks that hand out tasks to ranks below them: what demand, guided and hierarchical have in
// common.
#pragma once

#include <cstdint>
#include <vector>

#include "loadbalance/schedule.h"

namespace delray::loadbalance::internal {

struct Masters {
  // The master of each rank, which has a lower number; that of rank 0, who has all tasks to begin
  // with, does not matter.
  std::vector<int> master;
  // How many of `rest` tasks that a master has go to a rank that asks, when `workers` ranks do
  // tasks there or below it; at least 1.
  parallel::FunctionRef<std::uint64_t(std::uint64_t rest, std::uint64_t workers)> amount;
};

// A master gives everybody below it tasks unasked once, and then whenever they ask, first come,
// first served; it asks its own master when it has none left. Who asked when there are no more is
// told so and is done. Nobody speaks to a master before that has spoken, so that one run's messages
// never meet another's.
RankReport run_masters(comm::Communicator& communicator, const TaskGrid& tasks,
                       const ScheduleOptions& options, TaskFunction work, const Masters& masters);

// options.batch, or this rank's number of threads.
std::uint64_t batch_of(const ScheduleOptions& options);

// Ranks that do tasks.
std::uint64_t workers(const std::vector<int>& master, const ScheduleOptions& options);

}  // namespace delray::loadbalance::internal
