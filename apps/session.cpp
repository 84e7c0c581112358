// Turns exceptions into messages, in one place for all subcommands.
#include "apps/session.h"

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <new>

#include "apps/interrupt.h"
#include "apps/launch.h"
#include "apps/options/help.h"
#include "comm/failure.h"

namespace delray::apps {
namespace {

// The message of the exception in flight.
std::string text_of_failure() {
  try {
    throw;
  } catch (const comm::OutOfMemory& error) {  // which names the rank
    return error.what();
  } catch (const std::bad_alloc&) {
    return "out of memory";
  } catch (const std::exception& error) {
    return error.what();
  }
}

}  // namespace

void add_common_options(CLI::App& command, Session& session, const std::string& examples) {
  command.add_flag("-q,--quiet", session.quiet, "Print errors only")->group(group::kGeneral);
  command.add_flag("-v,--verbose", session.verbose, "Print more details")->group(group::kGeneral);
  std::string footer = "Examples:\n";
  for (std::size_t start = 0; start < examples.size();) {
    const std::size_t end = std::min(examples.find('\n', start), examples.size());
    footer += "  delray " + examples.substr(start, end - start) + "\n";
    start = end + 1;
  }
  command.footer(footer);
}

int run_guarded(Session& session) {
  // Ranks that work together would all say the same.
  const bool silent = session.quiet || (session.has_ranks && !session.first_process);
  spdlog::set_level(silent            ? spdlog::level::err
                    : session.verbose ? spdlog::level::debug
                                      : spdlog::level::info);
  const StopOnInterrupt stop(session.progress);
  try {
    const int code = session.run();
    if (session.processes > 1 && session.first_process && !session.has_ranks) {
      spdlog::warn("each of the {} processes has done all of this: {} shares nothing with ranks",
                   session.processes, session.command);
    }
    return code;
  } catch (...) {
    // All processes of mpirun are here with the same failure; one speaks, and exits with the code,
    // for mpirun ends the others when it does.
    if (session.first_process || !session.has_ranks) {
      spdlog::error("{}", text_of_failure());
      return comm::exit_code_of(std::current_exception());
    }
    if (!has_met_ranks()) fail_where_ranks_meet(session, text_of_failure());
    return kDone;
  }
}

}  // namespace delray::apps
