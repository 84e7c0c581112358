// Half of the rest (Ellsworth 1994): an idle rank takes half of what waits at the most loaded one.
//
// How much that is the loaded rank says, of what it has when it is asked: ranks that find it at the
// same time get a half, a quarter, an eighth, and do not take all of it together. As few requests
// as can be, where `stealing` asks all above the mean; 2 (ranks - 1) messages to learn the loads,
// each time a rank runs dry. Degenerate: of a single task that waits the half is that task.
#include <algorithm>

#include "loadbalance/schedules/schedules.h"
#include "loadbalance/schedules/steal_by_loads.h"

namespace delray::loadbalance::internal {
namespace {

std::uint64_t half_of(std::uint64_t waiting, std::uint64_t) { return (waiting + 1) / 2; }

std::vector<StealRequest> from_the_most_loaded(std::span<const std::uint64_t> loads) {
  const auto most = std::ranges::max_element(loads);
  if (most == loads.end() || *most == 0) return {};
  return {{static_cast<int>(most - loads.begin()), half_of(*most, 0)}};
}

}  // namespace

const StealingRule kStealHalf = {from_the_most_loaded, half_of};

RankReport half_stealing(comm::Communicator& communicator, const TaskGrid& tasks,
                         const ScheduleOptions& options, TaskFunction work) {
  return steal_by_loads(communicator, tasks, options, work, kStealHalf);
}

}  // namespace delray::loadbalance::internal
