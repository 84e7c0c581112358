// Consecutive tasks, as many for each rank, or the ones that the options name; schedules with
// stealing begin with these too.
#include <stdexcept>

#include "loadbalance/schedules/initial_tasks.h"
#include "loadbalance/schedules/schedules.h"
#include "loadbalance/schedules/task_runner.h"

namespace delray::loadbalance::internal {

std::vector<TaskRange> initial_tasks(const comm::Communicator& communicator, const TaskGrid& tasks,
                                     const ScheduleOptions& options) {
  if (options.initial) {
    for (const TaskRange& range : *options.initial) {
      if (range.first > range.last || range.last > tasks.count())
        throw std::invalid_argument("a rank begins with tasks that there are not");
    }
    return *options.initial;
  }
  const auto begin = [&](int rank) {
    return static_cast<std::uint32_t>(std::uint64_t{tasks.count()} *
                                      static_cast<std::uint64_t>(rank) /
                                      static_cast<std::uint64_t>(communicator.size()));
  };
  return {{begin(communicator.rank()), begin(communicator.rank() + 1)}};
}

RankReport static_schedule(comm::Communicator& communicator, const TaskGrid& tasks,
                           const ScheduleOptions& options, TaskFunction work) {
  TaskRunner runner(communicator, options, work);
  runner.put(initial_tasks(communicator, tasks, options));
  return runner.finish();
}

}  // namespace delray::loadbalance::internal
