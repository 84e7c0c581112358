// Ranks: threads of this process, or the processes that mpirun started.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "apps/session.h"
#include "comm/communicator.h"

namespace delray::apps {

// Ranks and threads of a command, and how long they wait for each other.
struct Launch {
  int ranks = 0;       // 0: not given
  int threads = 0;     // workers per rank; 0: cores / ranks
  double timeout = 0;  // seconds that a rank waits for another; 0: without end
  std::string record;  // the ledger to write; empty: none
};

// Finds out whether this process is one of several that an MPI launcher started.
void find_launcher(Session& session);

// The number of the launcher's processes that share this machine.
int processes_here();

// Tells the session what was asked for, of a command line as far as it was understood. `arguments`
// are those of the program.
void note_options(const CLI::App& program, const std::vector<std::string>& arguments,
                  Session& session);

// Adds --ranks, --threads, --timeout and --record.
void add_launch_options(CLI::App& command, Launch& launch);
// --timeout alone.
void add_timeout_option(CLI::App& command, Launch& launch);

// Throws UsageError for --timeout and --record where no rank waits for another, and for a ledger
// that would overwrite what the command reads or writes otherwise, FileError where none could be
// written.
void check(const Session& session, const Launch& launch);

// The number of threads that each of `ranks` ranks on this machine gets.
int threads_per_rank(const Launch& launch, int ranks);

// Processes of mpirun that are not at the same work would wait for each other for ever, or make a
// picture that is none. Throws std::invalid_argument on all where the build, the options or the
// content of `inputs` (files::fingerprint) differ. Collective.
void compare_ranks(comm::Communicator& communicator, const Session& session,
                   const std::vector<std::string>& inputs);

// Ends the processes of mpirun that meet in compare_ranks, since this one cannot begin; rank 0
// reports `why`. Returns when they have met, at once without mpirun.
void fail_where_ranks_meet(const Session& session, const std::string& why);
// Whether this process has met those of mpirun in run_ranks.
bool has_met_ranks();

// Runs `body` on every rank, each inside an arena of its own, and returns when all have. Throws
// what a rank threw (bad input, interruption) or comm::RankFailure. UsageError: --ranks under
// mpirun. `inputs` are files that every rank reads, see compare_ranks. `waiting` says what
// processes do that wait for others when the session is asked to stop: go on, as the others agree
// on when to stop; or throw parallel::Interrupted at once.
enum class Waiting : std::uint8_t { goes_on, stops };
void run_ranks(const Session& session, const Launch& launch, const std::vector<std::string>& inputs,
               const std::function<void(comm::Communicator&)>& body,
               Waiting waiting = Waiting::goes_on);

}  // namespace delray::apps
