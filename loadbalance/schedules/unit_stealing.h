// Stealing of units of tasks that are begun (DivisibleWork): what ray-stealing and
// ray-neighbours have in common.
#pragma once

#include "loadbalance/schedule.h"

namespace delray::loadbalance::internal {

// Whom an idle rank asks.
enum class Asked : std::uint8_t { all_by_load, neighbours };

// REQUIRES: options.divisible is there.
RankReport unit_stealing(comm::Communicator& communicator, const TaskGrid& tasks,
                         const ScheduleOptions& options, TaskFunction work, Asked asked);

}  // namespace delray::loadbalance::internal
