#include <cassert>

#include "loadbalance/internal/masters.h"
#include "loadbalance/internal/schedules.h"

namespace delray::loadbalance::internal {

RankReport hierarchical(comm::Communicator& communicator, const TaskGrid& tasks,
                        const ScheduleOptions& options, TaskFunction work) {
  assert(options.fan_out >= 2);
  std::vector<int> master(static_cast<std::size_t>(communicator.size()), 0);
  for (int k = 1; k < communicator.size(); ++k) master[k] = (k - 1) / options.fan_out;
  const std::uint64_t batch = batch_of(options);
  const auto amount = [batch](std::uint64_t, std::uint64_t workers) { return batch * workers; };
  return run_masters(communicator, tasks, options, work, {master, amount});
}

}  // namespace delray::loadbalance::internal
