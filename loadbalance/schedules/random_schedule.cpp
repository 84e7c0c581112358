// Static random assignment: every rank makes the same shuffle (Fisher and Yates) from the seed and
// takes its own entries. O(tasks).
#include <numeric>
#include <random>
#include <utility>

#include "loadbalance/schedules/schedules.h"
#include "loadbalance/schedules/task_runner.h"

namespace delray::loadbalance::internal {

RankReport random_schedule(comm::Communicator& communicator, const TaskGrid& tasks,
                           const ScheduleOptions& options, TaskFunction work) {
  TaskRunner runner(communicator, options, work);
  std::vector<std::uint32_t> order(tasks.count());
  std::iota(order.begin(), order.end(), 0U);
  // Not std::shuffle, which differs between libraries: ranks must agree.
  std::mt19937_64 random(options.seed);
  for (std::size_t k = order.size(); k > 1; --k) std::swap(order[k - 1], order[random() % k]);
  std::vector<TaskRange> mine;
  for (auto k = static_cast<std::size_t>(communicator.rank()); k < order.size();
       k += static_cast<std::size_t>(communicator.size())) {
    mine.push_back({order[k], order[k] + 1});
  }
  runner.put(mine);
  return runner.finish();
}

}  // namespace delray::loadbalance::internal
