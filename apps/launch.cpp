#include "apps/launch.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>

#include "comm/mpi.h"
#include "comm/threads.h"
#include "parallel/arena.h"

namespace delray::apps {

int processes_here() {
  for (const char* name :
       {"OMPI_COMM_WORLD_LOCAL_SIZE", "MPI_LOCALNRANKS", "SLURM_NTASKS_PER_NODE"}) {
    if (const char* value = std::getenv(name)) return std::max(1, std::atoi(value));
  }
  return 1;
}

void find_launcher(Session& session) {
  session.under_mpi = comm::launched_by_mpi();
  session.first_process = comm::launched_rank() == 0;
}

void add_launch_options(CLI::App& command, Launch& launch) {
  command.add_option("--ranks", launch.ranks, "ranks, as threads of this process (default 1)")
      ->check(CLI::Range(1, 4096));
  command
      .add_option("--threads", launch.threads,
                  "workers per rank (default: cores / ranks, at least 1)")
      ->check(CLI::Range(1, 4096));
}

int threads_per_rank(const Launch& launch, int ranks) {
  return launch.threads > 0 ? launch.threads : std::max(1, parallel::arena_threads() / ranks);
}

void run_ranks(const Session& session, const Launch& launch,
               const std::function<void(comm::Communicator&)>& body, Waiting waiting) {
  if (!session.under_mpi) {
    const int ranks = std::max(1, launch.ranks);
    comm::run_threads(ranks, threads_per_rank(launch, ranks), body);
    return;
  }
  if (launch.ranks > 0) throw UsageError("--ranks: under mpirun the ranks are its processes");
  const int threads = threads_per_rank(launch, processes_here());
  comm::MpiOptions options;
  if (waiting == Waiting::stops) options.progress = &session.progress;
  comm::run_mpi(
      nullptr, nullptr,
      [&](comm::Communicator& communicator) {
        const parallel::AllowThreads allowed(threads);
        parallel::Arena arena(threads);
        arena.execute([&] { body(communicator); });
      },
      options);
}

}  // namespace delray::apps
