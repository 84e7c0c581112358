// Runs a schedule on the simulated machine with one thread to a rank; a task is work of a known
// number of nanoseconds, its result a part of a message of a known size.
#include "loadbalance/simulated_schedule.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "comm/collectives.h"
#include "comm/simulated.h"
#include "parallel/arena.h"

namespace delray::loadbalance {

namespace {

// Sends a rank's results to rank 0, where they become a part of all.
void gather_results(comm::Communicator& communicator, const SimulatedTasks& tasks,
                    std::uint64_t mine, std::uint64_t all) {
  const auto copy = [&](std::uint64_t bytes) {
    communicator.work(
        comm::Work::seconds_e9,
        static_cast<std::uint64_t>(static_cast<double>(bytes) * tasks.seconds_per_byte * 1e9));
  };
  const bool root = communicator.rank() == 0;
  if (!root) copy(mine);
  comm::gather(communicator, 0,
               root ? comm::Buffer()
                    : comm::Buffer::standing_for(tasks.message_bytes + mine, comm::Buffer()));
  if (root) copy(all - mine);
}

}  // namespace

SimulatedSchedule simulate(const Schedule& schedule, const SimulatedTasks& tasks, int ranks,
                           const comm::Network& network, const ScheduleOptions& options) {
  const std::size_t count = tasks.grid.count();
  if (tasks.seconds.size() != count ||
      (!tasks.result_bytes.empty() && tasks.result_bytes.size() != count))
    throw std::invalid_argument("there are not as many times as tasks");
  if (ranks < 1) throw std::invalid_argument("there is at least one rank");
  SimulatedSchedule result;
  result.ranks.resize(static_cast<std::size_t>(ranks));
  result.owners.assign(count, -1);
  const std::uint64_t all_bytes =
      std::accumulate(tasks.result_bytes.begin(), tasks.result_bytes.end(), std::uint64_t{0});
  ScheduleOptions how = options;
  how.threads = 1;
  parallel::Arena(1).execute([&] {
    comm::run_simulated(ranks, network, 1, [&](comm::Communicator& communicator) {
      const int rank = communicator.rank();
      std::uint64_t mine = 0;
      result.ranks[static_cast<std::size_t>(rank)] =
          schedule.run(communicator, tasks.grid, how, [&](std::uint32_t task, int) {
            result.owners[task] = rank;
            if (!tasks.result_bytes.empty()) mine += tasks.result_bytes[task];
            communicator.work(comm::Work::seconds_e9,
                              static_cast<std::uint64_t>(tasks.seconds[task] * 1e9 + 0.5));
          });
      if (!tasks.result_bytes.empty()) gather_results(communicator, tasks, mine, all_bytes);
      if (rank == 0) result.frame_seconds = communicator.seconds();
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
