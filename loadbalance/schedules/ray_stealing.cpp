// Stealing of pending rays: the pool of rays of all ranks, shared by taking from each other
// (Badouel et al. 1990 as the general strategy of Heirich and Arvo 1997 has it).
//
// The load of a rank is its units that wait: camera rays of tasks that it has not begun, and
// whatever its tasks in progress still have to trace. An idle rank asks all for their loads and
// takes as much as the mean from those above it, as `stealing` does of whole tasks, so that not
// even a single task keeps others idle. 2 (ranks - 1) messages to learn the loads, each time a rank
// runs dry.
//
// Degenerate: work that is not divisible is stolen by whole tasks.
#include "loadbalance/schedules/schedules.h"
#include "loadbalance/schedules/unit_stealing.h"

namespace delray::loadbalance::internal {

RankReport ray_stealing(comm::Communicator& communicator, const TaskGrid& tasks,
                        const ScheduleOptions& options, TaskFunction work) {
  if (options.divisible == nullptr) return stealing(communicator, tasks, options, work);
  return unit_stealing(communicator, tasks, options, work, Asked::all_by_load);
}

}  // namespace delray::loadbalance::internal
