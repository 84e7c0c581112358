// delray replay: what a recorded run would take on other networks.
//
// Every rank of the ledger repeats its messages and its work on the simulated machine
// (comm/replay.h), once for each network; the figures are those of the rank that is done last.
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "apps/commands.h"
#include "apps/families.h"
#include "apps/options/help.h"
#include "apps/options/network_option.h"
#include "apps/options/outputs.h"
#include "apps/statistics.h"
#include "apps/terminal/terminal.h"
#include "apps/terminal/text_table.h"
#include "comm/failure.h"
#include "comm/ledger_file.h"
#include "comm/network_file.h"
#include "comm/replay.h"
#include "files/error.h"

namespace delray::apps {
namespace {

struct ReplayRequest {
  std::string ledger, statistics;
  NetworkChoice network;
  bool list = false;
};

// A network, and where the time of the rank goes that is done last.
struct Replayed {
  std::string network;
  double seconds = 0;
  comm::PhaseSeconds last;  // of all phases
};

Replayed replay_over(const comm::RecordedRun& run, const comm::NamedNetwork& named,
                     const std::string& file) {
  Replayed result{named.name, 0, {}};
  try {
    for (const comm::ReplayedRank& rank : replay_phases(run.ledger, named.network)) {
      if (rank.end < result.seconds) continue;
      result.seconds = rank.end;
      result.last = {};
      for (const comm::PhaseSeconds& phase : rank.phases) {
        result.last.work += phase.work;
        result.last.handling += phase.handling;
        result.last.waiting += phase.waiting;
      }
    }
  } catch (const comm::RankFailure& failure) {
    throw files::FileError(files::Cause::input, file, "",
                           fmt::format("ranks wait for each other: {}", failure.what()));
  }
  return result;
}

std::string milliseconds(double seconds) { return fmt::format("{:.4g}", seconds * 1e3); }

TextTable replay_table(const comm::RecordedRun& run, const std::vector<Replayed>& rows) {
  TextTable table = {
      {"network", "ms, predicted", "over recorded", "work ms", "messages ms", "waiting ms"}};
  table.push_back({"recorded", milliseconds(run.seconds), "1.000", "-", "-", "-"});
  for (const Replayed& row : rows) {
    table.push_back({row.network, milliseconds(row.seconds),
                     run.seconds > 0 ? fmt::format("{:.3f}", row.seconds / run.seconds) : "-",
                     milliseconds(row.last.work), milliseconds(row.last.handling),
                     milliseconds(row.last.waiting)});
  }
  return table;
}

// Warns where the recorded time is not that of the run alone.
void warn_of_others(const comm::RecordedRun& run) {
  constexpr double kFew = 0.1;  // cores
  if (run.other_programs <= kFew) return;
  spdlog::warn(
      "other programs took {:.2g} cores of the machine while this was recorded: it would have been "
      "faster alone, as replays are",
      run.other_programs);
}

Json replay_statistics(const ReplayRequest& request, const comm::RecordedRun& run,
                       const std::vector<comm::NamedNetwork>& networks,
                       const std::vector<Replayed>& replayed) {
  const comm::Totals totals = comm::totals(run.ledger);
  Json rows = Json::array(), described = Json::array();
  for (const Replayed& row : replayed) {
    rows.push_back({{"network", row.network},
                    {"seconds", row.seconds},
                    {"last_rank",
                     {{"work", row.last.work},
                      {"messages", row.last.handling},
                      {"waiting", row.last.waiting}}}});
  }
  for (const comm::NamedNetwork& named : networks)
    described.push_back(Json::parse(comm::network_text(named)));
  return {{"schema", "delray.replay/1"},
          {"ledger",
           {{"file", request.ledger},
            {"program", run.program},
            {"ranks", run.ledger.ranks.size()},
            {"messages", totals.messages_sent},
            {"bytes", totals.bytes_sent},
            {"seconds", run.seconds},
            {"other_programs", run.other_programs < 0 ? Json() : Json(run.other_programs)}}},
          {"networks", std::move(described)},
          {"rows", std::move(rows)}};
}

int run_replay(Session& session, const ReplayRequest& request) {
  if (request.list) {
    list_networks();
    return kDone;
  }
  if (session.under_mpi)
    throw UsageError("replay: its ranks are simulated in one process; leave out mpirun");
  if (request.ledger.empty()) throw UsageError("replay: LEDGER is missing");
  check_outputs({{"--stats", request.statistics}}, {request.ledger});
  const comm::RecordedRun run = comm::read_ledger(request.ledger);
  std::vector<comm::NamedNetwork> otherwise = {run.machine};
  otherwise.front().name = kThisMachine;
  for (const comm::NamedNetwork& named : comm::default_networks()) otherwise.push_back(named);
  const int ranks = static_cast<int>(run.ledger.ranks.size());
  const std::vector<comm::NamedNetwork> networks =
      networks_of(request.network, {&ranks, 1}, otherwise);
  std::vector<Replayed> rows;
  for (const comm::NamedNetwork& named : networks)
    rows.push_back(replay_over(run, named, request.ledger));
  warn_of_others(run);
  write_statistics(request.statistics, replay_statistics(request, run, networks, rows));
  if (request.statistics != "-")
    fmt::print("{}", aligned(replay_table(run, rows), line_width(STDOUT_FILENO)));
  return kDone;
}

}  // namespace

void add_replay(CLI::App& program, Session& session) {
  CLI::App* command =
      program.add_subcommand("replay", "Predict what a recorded run would take on other networks");
  const auto request = std::make_shared<ReplayRequest>();
  command->add_option("LEDGER", request->ledger,
                      "Ledger that --record, or libdelray_record.so under any MPI program, wrote");
  add_network_option(*command, request->network,
                     "(default: this-machine, as its messages were recorded, "
                     "gigabit-ethernet, 10-gigabit-ethernet, hdr-infiniband, shared-bus)",
                     true);
  command
      ->add_option("--stats", request->statistics,
                   "Figures as JSON to this file; - for standard output")
      ->type_name("FILE")
      ->group(group::kOutput);
  command->add_flag("--list", request->list, "List the networks")->group(group::kOutput);
  add_common_options(*command, session,
                     "replay ledger.json --network this-machine,hypercube,own.json\n"
                     "replay ledger.json --stats replay.json");
  command->callback([&session, request] {
    session.run = [&session, request] { return run_replay(session, *request); };
  });
}

}  // namespace delray::apps
