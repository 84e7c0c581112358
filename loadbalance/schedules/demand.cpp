// Demand driven (Badouel et al. 1990): the masters' protocol with a single master and batches of
// one size.
#include "loadbalance/schedules/masters.h"
#include "loadbalance/schedules/schedules.h"

namespace delray::loadbalance::internal {

RankReport demand(comm::Communicator& communicator, const TaskGrid& tasks,
                  const ScheduleOptions& options, TaskFunction work) {
  const std::uint64_t batch = batch_of(options);
  const auto amount = [batch](std::uint64_t, std::uint64_t) { return batch; };
  return run_masters(communicator, tasks, options, work, MasterTree::flat(communicator, options),
                     amount);
}

}  // namespace delray::loadbalance::internal
