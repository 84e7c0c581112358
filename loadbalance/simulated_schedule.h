// A schedule on the simulated machine, with tasks whose times are known: who would do what, and
// when, of as many ranks as one likes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "comm/network.h"
#include "loadbalance/schedule.h"

namespace delray::loadbalance {

// Tasks whose times are known, and what their results cost on the way to rank 0, where they go in
// one message of each rank once it gets no more tasks.
struct SimulatedTasks {
  TaskGrid grid;
  std::span<const double> seconds;                   // of task i
  std::span<const std::uint64_t> result_bytes = {};  // of task i; empty: nothing is gathered
  std::uint64_t message_bytes = 0;                   // of a message besides
  double seconds_per_byte = 0;                       // packing on a rank, unpacking on rank 0
  // Of task i, for schedules that divide tasks, each of which takes as long with all that follows
  // from it; empty: tasks stay whole. And the bytes of one that goes to another rank, and of what
  // is found of it there.
  std::span<const std::uint64_t> units = {};
  double unit_bytes = 0, unit_result_bytes = 0;
  std::span<const std::uint64_t> rays = {};  // of task i, to be added up by rank; empty: none are
};

// A run of a schedule on the simulated machine.
struct SimulatedSchedule {
  std::vector<RankReport> ranks;
  std::vector<int> owners;  // of task i: the rank that did it, or began it
  // By rank: seconds at tasks, and the rays of those, the same part of a task's that was done
  // there.
  std::vector<double> busy, rays;
  double seconds = 0;        // from the first rank's begin to the last task's end
  double frame_seconds = 0;  // until rank 0 has all results
};

// Runs the schedule's own code; a task takes a rank the virtual time that tasks.seconds says. Ranks
// have one thread each. O(log ranks) per message and task.
//
// REQUIRES: ranks >= 1; as many seconds as tasks, and bytes, units and rays if any, none negative;
// `options` has no `initial`.
SimulatedSchedule simulate(const Schedule& schedule, const SimulatedTasks& tasks, int ranks,
                           const comm::Network& network, const ScheduleOptions& options = {});

}  // namespace delray::loadbalance
