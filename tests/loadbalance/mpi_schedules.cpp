// Every schedule over MPI, several runs one after the other; ends with 1 unless every task was done
// exactly once. Run it under mpirun with any number of processes.
#include <chrono>
#include <cstdio>
#include <functional>
#include <thread>

#include "comm/collectives.h"
#include "comm/mpi.h"
#include "loadbalance/schedule.h"

using namespace delray;

namespace {

// Rank 1 takes ten times as long.
int wrong_tasks(comm::Communicator& communicator, const loadbalance::Schedule& schedule,
                const loadbalance::TaskGrid& grid, bool master_works) {
  std::vector<int> times(grid.count());
  loadbalance::ScheduleOptions options;
  options.threads = 2;
  options.fan_out = 2;
  options.master_works = master_works;
  const auto pause = std::chrono::microseconds(communicator.rank() == 1 ? 300 : 30);
  const loadbalance::RankReport report =
      schedule.run(communicator, grid, options, [&](std::uint32_t task, int) {
        ++times[task];
        std::this_thread::sleep_for(pause);
      });
  const auto reports = loadbalance::gather_reports(communicator, report);
  comm::all_reduce(communicator, std::span<int>(times), std::plus<>());
  int wrong = 0;
  for (const int count : times) wrong += count == 1 ? 0 : 1;
  std::uint64_t tasks = 0;
  for (const auto& from : reports) tasks += from.tasks;
  if (communicator.rank() == 0 && tasks != grid.count()) ++wrong;
  return wrong;
}

}  // namespace

int main(int argc, char** argv) {
  int wrong = 0;
  comm::run_mpi(&argc, &argv, [&](comm::Communicator& communicator) {
    for (const loadbalance::Schedule& schedule : loadbalance::schedules()) {
      for (const loadbalance::TaskGrid grid : {loadbalance::TaskGrid{13, 11}, {2, 1}, {0, 0}}) {
        for (const bool master_works : {true, false}) {
          const int here = wrong_tasks(communicator, schedule, grid, master_works);
          if (here > 0 && communicator.rank() == 0) {
            std::printf("%s: %d of %u tasks not done exactly once\n", schedule.name, here,
                        grid.count());
          }
          wrong += here;
        }
      }
    }
  });
  return wrong == 0 ? 0 : 1;
}
