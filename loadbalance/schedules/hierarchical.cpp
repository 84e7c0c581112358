// A tree of masters (Green and Paddon 1990): the masters' protocol with a limited fan-out, where a
// rank that asks gets a batch for every rank that works below it.
#include <stdexcept>

#include "loadbalance/schedules/masters.h"
#include "loadbalance/schedules/schedules.h"

namespace delray::loadbalance::internal {

RankReport hierarchical(comm::Communicator& communicator, const TaskGrid& tasks,
                        const ScheduleOptions& options, TaskFunction work) {
  if (options.fan_out < 2) throw std::invalid_argument("hierarchical: a fan-out is at least 2");
  const MasterTree tree{communicator.size(), options.fan_out, options.master_works};
  const std::uint64_t batch = batch_of(options);
  const auto amount = [batch](std::uint64_t, std::uint64_t workers) { return batch * workers; };
  return run_masters(communicator, tasks, options, work, tree, amount);
}

}  // namespace delray::loadbalance::internal
