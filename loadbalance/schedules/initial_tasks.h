// The static share that a rank begins with.
#pragma once

#include <vector>

#include "loadbalance/schedule.h"

namespace delray::loadbalance::internal {

// options.initial, or the consecutive tasks from count * rank / ranks on.
std::vector<TaskRange> initial_tasks(const comm::Communicator& communicator, const TaskGrid& tasks,
                                     const ScheduleOptions& options);

}  // namespace delray::loadbalance::internal
