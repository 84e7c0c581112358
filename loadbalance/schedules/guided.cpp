// Guided self-scheduling (Polychronopoulos and Kuck 1987) by whole rows (Pandzic et al. 1995): the
// masters' protocol with a single master and batches that are a fixed part of what is left.
//
// O(ranks log(rows / ranks)) batches. Degenerate: batches of less than a row, and all batches of
// tasks that lie in one row, are counted in tasks.
#include <algorithm>
#include <stdexcept>

#include "loadbalance/schedules/masters.h"
#include "loadbalance/schedules/schedules.h"

namespace delray::loadbalance::internal {

RankReport guided(comm::Communicator& communicator, const TaskGrid& tasks,
                  const ScheduleOptions& options, TaskFunction work) {
  if (!(options.share > 0)) throw std::invalid_argument("guided: the share is above 0");
  const MasterTree tree = MasterTree::flat(communicator, options);
  const double part = options.share / static_cast<double>(tree.workers(0));
  const std::uint64_t row = std::max(1U, tasks.rows > 1 ? tasks.columns : 1U);
  const std::uint64_t least = batch_of(options);
  const auto amount = [part, row, least](std::uint64_t rest, std::uint64_t) {
    const auto count =
        std::max(least, static_cast<std::uint64_t>(part * static_cast<double>(rest)));
    return count < row ? count : count / row * row;
  };
  return run_masters(communicator, tasks, options, work, tree, amount);
}

}  // namespace delray::loadbalance::internal
