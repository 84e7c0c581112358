// Starts ranks as threads or joins the processes of mpirun, which first compare build, options and
// inputs.
#include "apps/launch.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <thread>

#include "apps/build_id.h"
#include "apps/options/help.h"
#include "apps/options/numbers.h"
#include "apps/options/outputs.h"
#include "apps/options/usage.h"
#include "apps/replay/record.h"
#include "comm/failure.h"
#include "comm/handshake.h"
#include "comm/mpi.h"
#include "comm/threads.h"
#include "files/fingerprint.h"
#include "parallel/arena.h"

namespace delray::apps {

int processes_here() {
  for (const char* name :
       {"OMPI_COMM_WORLD_LOCAL_SIZE", "MPI_LOCALNRANKS", "SLURM_NTASKS_PER_NODE"}) {
    if (const char* value = std::getenv(name)) return std::max(1, std::atoi(value));
  }
  return 1;
}

namespace {

std::chrono::nanoseconds timeout_of(const Launch& launch) {
  constexpr auto kNever = std::chrono::nanoseconds::max();
  if (launch.timeout <= 0) return kNever;
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::duration<double>(launch.timeout));
}

// A rank that computes for ever cannot be ended but with the process.
[[noreturn]] void end_process(const comm::RankFailure& failure) {
  spdlog::error("{}", failure.what());
  std::_Exit(kRankLost);
}

// Options that each rank may choose for itself.
bool is_own_affair(const std::string& option) {
  return option == "--quiet" || option == "--verbose" || option == "--threads" ||
         option == "--memory";
}

bool met_ranks = false;

void meet(comm::Communicator& communicator, const Session& session, const std::string& error,
          std::vector<comm::Fact> facts) {
  facts.insert(facts.begin(),
               {{"build", fmt::format("{} {}", DELRAY_VERSION, build_id())}, {"errors", error}});
  facts.insert(facts.end(), session.options.begin(), session.options.end());
  comm::handshake(communicator, facts);
}

}  // namespace

void find_launcher(Session& session) {
  session.under_mpi = comm::launched_by_mpi();
  session.first_process = comm::launched_rank() == 0;
  session.processes = comm::launched_size();
}

void note_options(const CLI::App& program, const std::vector<std::string>& arguments,
                  Session& session) {
  const CLI::App& command = command_of(program, arguments);
  session.has_ranks = command.get_option_no_throw("--timeout") != nullptr;
  session.command = command.get_name();
  session.options = {{"command", session.command}};
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = option->get_name();
    if (option->count() == 0 || is_own_affair(name)) continue;
    session.options.push_back({name, fmt::format("{}", fmt::join(option->results(), " "))});
  }
}

void add_timeout_option(CLI::App& command, Launch& launch) {
  command
      .add_option("--timeout", launch.timeout,
                  "Seconds after which a rank that others wait for counts as lost, which ends the "
                  "run with exit code 5 (default: none)")
      ->group(group::kParallel)
      ->check(positive_number());
}

void check(const Session& session, const Launch& launch) {
  if (launch.timeout > 0 && !session.under_mpi && launch.ranks <= 1)
    throw UsageError("--timeout has no effect with a single rank, which waits for no other");
  if (launch.record.empty()) return;
  if (!session.under_mpi && launch.ranks <= 1)
    throw UsageError("--record has no effect with a single rank, which sends no messages");
  if (session.processes > 1 && !session.first_process) return;
  std::vector<std::string> others;
  for (const comm::Fact& option : session.options) {
    if (option.what == "--record" || option.what == "command") continue;
    others.push_back(option.value);
    std::istringstream words(option.value);  // of an option that takes several
    for (std::string one; words >> one;) others.push_back(one);
  }
  check_outputs({{"--record", launch.record}}, others);
}

void add_launch_options(CLI::App& command, Launch& launch) {
  command
      .add_option("--ranks", launch.ranks,
                  "Ranks to share the work, within this process (default: 1); under mpirun its "
                  "processes are the ranks")
      ->group(group::kParallel)
      ->transform(count_between(1, 4096));
  command
      .add_option("--threads", launch.threads,
                  "Threads per rank (default: cores divided by ranks, at least 1)")
      ->group(group::kParallel)
      ->transform(count_between(1, 4096));
  add_timeout_option(command, launch);
  command
      .add_option("--record", launch.record,
                  "Ledger of what ranks send, receive and work, as JSON, for delray replay")
      ->type_name("FILE")
      ->group(group::kParallel);
}

int threads_per_rank(const Launch& launch, int ranks) {
  return launch.threads > 0 ? launch.threads : std::max(1, parallel::arena_threads() / ranks);
}

void compare_ranks(comm::Communicator& communicator, const Session& session,
                   const std::vector<std::string>& inputs) {
  if (communicator.size() == 1) return;
  std::vector<comm::Fact> facts;
  for (const std::string& input : inputs) {
    const files::Fingerprint print = files::fingerprint(input);
    if (print.parts.empty()) continue;
    facts.push_back({input, fmt::format("{} bytes", print.bytes)});
    for (const files::Fingerprint::Part& part : print.parts) {
      facts.push_back({fmt::format("{}, from byte {}", input, part.begin), "hash " + part.hash});
    }
  }
  meet(communicator, session, "none", std::move(facts));
}

void fail_where_ranks_meet(const Session& session, const std::string& why) {
  if (!session.under_mpi || !session.has_ranks) return;
  try {
    comm::run_mpi(nullptr, nullptr,
                  [&](comm::Communicator& communicator) { meet(communicator, session, why, {}); });
  } catch (const std::invalid_argument&) {  // rank 0 reports it
  }
}

bool has_met_ranks() { return met_ranks; }

void run_ranks(const Session& session, const Launch& launch, const std::vector<std::string>& inputs,
               const std::function<void(comm::Communicator&)>& run, Waiting waiting) {
  const int ranks_here = session.under_mpi ? processes_here() : std::max(1, launch.ranks);
  const auto body = [&](comm::Communicator& communicator) {
    if (launch.record.empty()) return run(communicator);
    const auto busy = static_cast<unsigned>(ranks_here) *
                      static_cast<unsigned>(threads_per_rank(launch, ranks_here));
    run_recorded(communicator,
                 {launch.record, session.command_line, busy <= std::thread::hardware_concurrency()},
                 run);
  };
  if (!session.under_mpi) {
    comm::run_threads(ranks_here, threads_per_rank(launch, ranks_here), body,
                      {.timeout = timeout_of(launch), .on_stuck = end_process});
    return;
  }
  if (launch.ranks > 0) throw UsageError("--ranks: under mpirun the ranks are its processes");
  const int threads = threads_per_rank(launch, ranks_here);
  comm::MpiOptions options;
  options.timeout = timeout_of(launch);
  met_ranks = true;
  if (waiting == Waiting::stops) options.progress = &session.progress;
  comm::run_mpi(
      nullptr, nullptr,
      [&](comm::Communicator& communicator) {
        compare_ranks(communicator, session, inputs);
        const parallel::AllowThreads allowed(threads);
        parallel::Arena arena(threads);
        arena.execute([&] { body(communicator); });
      },
      options);
}

}  // namespace delray::apps
