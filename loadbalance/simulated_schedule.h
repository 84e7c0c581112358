// A schedule on the simulated machine, with tasks whose times are known: who would do what, and
// when, of as many ranks as one likes.
#pragma once

#include <span>
#include <vector>

#include "comm/network.h"
#include "loadbalance/schedule.h"

namespace delray::loadbalance {

// A run of a schedule on the simulated machine.
struct SimulatedSchedule {
  std::vector<RankReport> ranks;
  std::vector<int> owners;  // of task i: the rank that did it
  double seconds = 0;       // from the first rank's begin to the last task's end
};

// Runs the schedule's own code; a task takes a rank the virtual time that seconds[task] says. Ranks
// have one thread each. O(log ranks) per message and task.
//
// REQUIRES: ranks >= 1; seconds.size() == tasks.count(), none negative; `options` has no `initial`.
SimulatedSchedule simulate(const Schedule& schedule, const TaskGrid& tasks,
                           std::span<const double> seconds, int ranks, const comm::Network& network,
                           const ScheduleOptions& options = {});

}  // namespace delray::loadbalance
