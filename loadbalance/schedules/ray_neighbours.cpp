// Stealing of pending rays from neighbours in the hypercube, before a rank runs dry (Heirich and
// Arvo 1997).
//
// A rank with few units left asks the ranks whose numbers differ from its own in one bit; they
// release half of what they have more. 2 log(ranks) messages each time.
//
// Degenerate: work that is not divisible is stolen by whole tasks.
#include "loadbalance/schedules/schedules.h"
#include "loadbalance/schedules/unit_stealing.h"

namespace delray::loadbalance::internal {

RankReport ray_neighbours(comm::Communicator& communicator, const TaskGrid& tasks,
                          const ScheduleOptions& options, TaskFunction work) {
  if (options.divisible == nullptr) return neighbour_stealing(communicator, tasks, options, work);
  return unit_stealing(communicator, tasks, options, work, Asked::neighbours);
}

}  // namespace delray::loadbalance::internal
