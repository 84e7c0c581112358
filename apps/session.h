// State that all subcommands share: how loud to be, how to stop, how to fail.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "comm/exit_code.h"
#include "comm/handshake.h"
#include "parallel/progress.h"

namespace CLI {
class App;
}

namespace delray::apps {

using enum comm::ExitCode;

// Options that cannot be, or cannot be together: exit code 2.
struct UsageError : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

struct Found;  // compare/comparison.h

// A run of the program: who speaks, what was asked for, and the wish to stop.
struct Session {
  bool quiet = false;
  bool verbose = false;
  bool under_mpi = false;
  bool first_process = true;  // the one that speaks; the only one without MPI
  int processes = 1;          // of mpirun
  std::string command_line;
  std::string command;              // the subcommand
  bool metadata = false;            // pictures tell how they were made: --metadata
  std::vector<comm::Fact> options;  // those that were given, but for what each rank may choose
  bool has_ranks = false;           // the subcommand runs on all processes of mpirun together
  parallel::Progress progress;
  std::function<int()> run;  // set by the subcommand that was chosen
  // Takes what `compare` found, where somebody else than the terminal and files is to have it.
  std::function<void(Found&&)> take_comparison;
};

// Adds -q and -v and the examples at the end of --help. `examples` are two lines, without "delray".
void add_common_options(CLI::App& command, Session& session, const std::string& examples);

// Runs what the subcommand set and turns exceptions into messages on stderr and exit codes.
int run_guarded(Session& session);

}  // namespace delray::apps
