// Ranks: threads of this process, or the processes that mpirun started.
#pragma once

#include <cstdint>
#include <functional>

#include "apps/session.h"
#include "comm/communicator.h"

namespace delray::apps {

struct Launch {
  int ranks = 0;    // 0: not given
  int threads = 0;  // workers per rank; 0: cores / ranks
};

// Finds out whether this process is one of several that an MPI launcher started.
void find_launcher(Session& session);

// How many processes of the launcher share this machine.
int processes_here();

// Adds --ranks and --threads.
void add_launch_options(CLI::App& command, Launch& launch);

// The number of threads that each of `ranks` ranks on this machine gets.
int threads_per_rank(const Launch& launch, int ranks);

// Runs `body` on every rank, each inside an arena of its own, and returns when all have. Throws
// what a rank threw (bad input, interruption) or comm::RankFailure. UsageError: --ranks under
// mpirun. `waiting` says what processes do that wait for others when the session is asked to stop:
// go on, as the others agree on when to stop; or throw parallel::Interrupted at once.
enum class Waiting : std::uint8_t { goes_on, stops };
void run_ranks(const Session& session, const Launch& launch,
               const std::function<void(comm::Communicator&)>& body,
               Waiting waiting = Waiting::goes_on);

}  // namespace delray::apps
