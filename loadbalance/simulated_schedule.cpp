// Runs a schedule on the simulated machine with one thread to a rank; a task is work of a known
// number of nanoseconds.
#include "loadbalance/simulated_schedule.h"

#include <algorithm>
#include <stdexcept>

#include "comm/simulated.h"
#include "parallel/arena.h"

namespace delray::loadbalance {

SimulatedSchedule simulate(const Schedule& schedule, const TaskGrid& tasks,
                           std::span<const double> seconds, int ranks, const comm::Network& network,
                           const ScheduleOptions& options) {
  if (seconds.size() != tasks.count())
    throw std::invalid_argument("there are not as many times as tasks");
  if (ranks < 1) throw std::invalid_argument("there is at least one rank");
  SimulatedSchedule result;
  result.ranks.resize(static_cast<std::size_t>(ranks));
  result.owners.assign(tasks.count(), -1);
  ScheduleOptions how = options;
  how.threads = 1;
  parallel::Arena(1).execute([&] {
    comm::run_simulated(ranks, network, 1, [&](comm::Communicator& communicator) {
      const int rank = communicator.rank();
      result.ranks[static_cast<std::size_t>(rank)] =
          schedule.run(communicator, tasks, how, [&](std::uint32_t task, int) {
            result.owners[task] = rank;
            communicator.work(comm::Work::seconds_e9,
                              static_cast<std::uint64_t>(seconds[task] * 1e9 + 0.5));
          });
    });
  });
  for (const RankReport& rank : result.ranks) {
    for (const Interval& interval : rank.timeline) {
      if (interval.kind == Interval::Kind::work)
        result.seconds = std::max(result.seconds, interval.end);
    }
  }
  return result;
}

}  // namespace delray::loadbalance
