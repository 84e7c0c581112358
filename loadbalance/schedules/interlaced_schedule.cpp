// Tasks in turn, without messages: each row begins one rank further on, so that columns are shared
// out as rows are.
#include "loadbalance/schedules/schedules.h"
#include "loadbalance/schedules/task_runner.h"

namespace delray::loadbalance::internal {

RankReport interlaced_schedule(comm::Communicator& communicator, const TaskGrid& tasks,
                               const ScheduleOptions& options, TaskFunction work) {
  TaskRunner runner(communicator, options, work);
  const auto ranks = static_cast<std::uint32_t>(communicator.size());
  const auto rank = static_cast<std::uint32_t>(communicator.rank());
  std::vector<TaskRange> mine;
  for (std::uint32_t j = 0; j < tasks.rows; ++j) {
    for (std::uint64_t i = (rank + ranks - j % ranks) % ranks; i < tasks.columns; i += ranks) {
      const std::uint32_t task = j * tasks.columns + static_cast<std::uint32_t>(i);
      mine.push_back({task, task + 1});
    }
  }
  runner.put(mine);
  return runner.finish();
}

}  // namespace delray::loadbalance::internal
