// Ranks that hand out tasks to ranks below them: what demand, guided and hierarchical have in
// common.
#pragma once

#include <cstdint>

#include "loadbalance/schedule.h"

namespace delray::loadbalance::internal {

// Who hands out tasks to whom: rank k to the ranks from k * fan_out + 1 on, `fan_out` of them.
struct MasterTree {
  std::int64_t ranks = 1, fan_out = 1;
  bool masters_work = true;

  // One master for all.
  static MasterTree flat(const comm::Communicator& communicator, const ScheduleOptions& options);

  int master(int rank) const { return static_cast<int>((rank - 1) / fan_out); }
  int first_below(int rank) const;
  int end_below(int rank) const;
  // Ranks that do tasks, there or below. O(levels).
  std::uint64_t workers(int rank) const;
};

// The number of tasks, of `rest` that a master has, that go to a rank that requests some, when
// `workers` ranks do tasks there or below it; at least 1.
using Amount = parallel::FunctionRef<std::uint64_t(std::uint64_t rest, std::uint64_t workers)>;

// A master gives everybody below it tasks unasked once, and then whenever they ask, first come,
// first served; it asks its own master when it has none left. Who asks when there are no more is
// told so and is done. Nobody speaks to a master before that has spoken, so that one run's messages
// never meet another's.
RankReport run_masters(comm::Communicator& communicator, const TaskGrid& tasks,
                       const ScheduleOptions& options, TaskFunction work, const MasterTree& tree,
                       Amount amount);

// options.batch, or this rank's number of threads.
std::uint64_t batch_of(const ScheduleOptions& options);

}  // namespace delray::loadbalance::internal
