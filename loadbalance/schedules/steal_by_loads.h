// Work stealing from ranks whose loads are known: what stealing and half-stealing have in common.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "loadbalance/schedule.h"

namespace delray::loadbalance::internal {

struct StealRequest {
  int rank = 0;
  std::uint64_t amount = 0;  // tasks, at least 1
  bool operator==(const StealRequest&) const = default;
};

// From whom an idle rank takes how much.
struct StealingRule {
  // Of a rank that knows the loads, tasks that wait, of all ranks; its own is 0. None where nobody
  // has any, and only then.
  std::vector<StealRequest> (*requests)(std::span<const std::uint64_t> loads);
  // What a rank releases of those that wait by the time it is asked; at least 1 where any wait.
  std::uint64_t (*released)(std::uint64_t waiting, std::uint64_t amount);
};

RankReport steal_by_loads(comm::Communicator& communicator, const TaskGrid& tasks,
                          const ScheduleOptions& options, TaskFunction work,
                          const StealingRule& rule);

// The rules of the schedules with these names.
extern const StealingRule kStealFromAboveMean, kStealHalf;

}  // namespace delray::loadbalance::internal
