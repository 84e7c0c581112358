// Work stealing by loads (Heirich and Arvo 1997): an idle rank learns all loads and takes as much
// as the mean from those above it, from each in proportion to its excess, with rounding errors
// carried on. 2 (ranks - 1) messages to learn the loads, each time a rank runs dry.
#include <algorithm>
#include <cmath>

#include "loadbalance/schedules/schedules.h"
#include "loadbalance/schedules/steal_by_loads.h"

namespace delray::loadbalance::internal {
namespace {

// As many tasks together as the mean, rounded up.
std::vector<StealRequest> from_those_above_the_mean(std::span<const std::uint64_t> loads) {
  std::vector<StealRequest> requests;
  double total = 0, excess = 0;
  for (const std::uint64_t load : loads) total += static_cast<double>(load);
  if (!(total > 0)) return requests;
  const double mean = total / static_cast<double>(loads.size());
  const double wanted = std::ceil(mean);
  for (const std::uint64_t load : loads) excess += std::max(0.0, static_cast<double>(load) - mean);
  // Rounding is carried on from one to the next, so that the sum is right.
  double before = 0, asked = 0;
  for (std::size_t rank = 0; rank < loads.size(); ++rank) {
    const auto load = static_cast<double>(loads[rank]);
    if (load <= mean) continue;
    before += load - mean;
    const double amount = std::min(load, std::round(wanted * before / excess) - asked);
    if (amount < 1) continue;
    asked += amount;
    requests.push_back({static_cast<int>(rank), static_cast<std::uint64_t>(amount)});
  }
  return requests;
}

std::uint64_t what_was_asked_for(std::uint64_t, std::uint64_t amount) { return amount; }

}  // namespace

const StealingRule kStealFromAboveMean = {from_those_above_the_mean, what_was_asked_for};

RankReport stealing(comm::Communicator& communicator, const TaskGrid& tasks,
                    const ScheduleOptions& options, TaskFunction work) {
  return steal_by_loads(communicator, tasks, options, work, kStealFromAboveMean);
}

}  // namespace delray::loadbalance::internal
