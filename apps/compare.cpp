// delray compare: variants of one thing on an input of the user's own.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>

#include "apps/commands.h"
#include "apps/compare_compose.h"
#include "apps/comparison.h"
#include "apps/compose_report.h"
#include "apps/list.h"
#include "apps/progress_bar.h"
#include "comm/agree_on_failure.h"
#include "composite/codec.h"
#include "composite/scheme.h"
#include "files/atomic_file.h"
#include "parallel/arena.h"

namespace delray::apps {
namespace {

void check(const CLI::App& command, const Session& session, CompareRequest& request) {
  if (request.render.scene.file.path.empty()) throw UsageError("compare compose: SCENE is missing");
  if (!request.output.empty() && !request.output.ends_with(".html")) {
    throw UsageError(fmt::format("-o: '{}' does not end in .html", request.output));
  }
  parse_size(request.render);
  request.render.behind = parse_background(request.render.background);
  if (session.under_mpi && command.count("--ranks") > 0) {
    throw UsageError("--ranks: under mpirun the ranks are its processes");
  }
  std::sort(request.ranks.begin(), request.ranks.end());
  request.ranks.erase(std::unique(request.ranks.begin(), request.ranks.end()), request.ranks.end());
  for (const std::string& codec : request.codecs) {
    find_entry(composite::codecs(), codec, "--codec");
  }
  for (const std::string& scheme : request.schemes) {
    if (composite::find_scheme(scheme) == nullptr) {
      find_entry(composite::schemes(), scheme, "--compose");
    }
  }
}

int run(Session& session, const CLI::App& command, CompareRequest request) {
  if (request.list) {
    print_table(composite::schemes());
    print_table(composite::codecs());
    print_table(comm::networks());
    return kDone;
  }
  check(command, session, request);
  const ProgressBar bar(session, "compare");
  parallel::Progress* const progress = &session.progress;
  const parallel::AllowThreads allowed(parallel::arena_threads());
  const auto prepared = parallel::Arena(parallel::arena_threads()).execute([&] {
    return prepare(request.render, progress);
  });
  const ComposeComparison comparison = compare_compose(session, request, *prepared, *progress);
  if (!session.first_process) return kDone;
  if (request.statistics != "-") print_comparison(comparison.rows);
  if (!request.output.empty()) {
    files::write_file(request.output, compose_report(session, request, *prepared, comparison));
  }
  write_statistics(request.statistics, comparison_statistics(request, *prepared, comparison));
  if (!comparison.unfinished) return kDone;
  spdlog::error("interrupted: what was finished is written");
  return kInterrupted;
}

void add_compare_compose(CLI::App& compare, Session& session) {
  CLI::App* command =
      compare.add_subcommand("compose", "every compositing scheme: counted, measured, predicted");
  const auto request = std::make_shared<CompareRequest>();
  add_scene_options(*command, request->render.scene);
  command->add_option("-o,--output", request->output,
                      "the report, a page that needs nothing else: .html");
  command->add_option("--size", request->render.size, "WIDTHxHEIGHT (default 1280x720)");
  add_camera_options(*command, request->render.camera);
  command
      ->add_option("--ranks", request->ranks,
                   "how many, separated by commas (default 2,3,4,8,16,64); more than 64 are "
                   "simulated")
      ->delimiter(',')
      ->check(CLI::Range(1, 4096));
  command->add_option("--threads", request->render.launch.threads, "workers per rank (default 1)")
      ->check(CLI::Range(1, 4096));
  command
      ->add_option("--codec", request->codecs,
                   "how pixels travel, separated by commas (default active)")
      ->delimiter(',');
  command->add_option("--compose", request->schemes, "schemes, separated by spaces (default all)");
  command->add_flag("--quick", request->quick, "measure once each");
  command->add_option("--stats", request->statistics, "write figures as JSON; - for stdout");
  command->add_flag("--list", request->list, "list schemes, codecs, networks");
  add_common_options(*command, session,
                     "compare compose model.glb --ranks 2,4,8,1024 --codec active,dense\n"
                     "compare compose gen:terrain:1000000 --size 1920x1080 --stats compose.json");
  command->callback([&session, request, command] {
    session.run = [&session, request, command] { return run(session, *command, *request); };
  });
}

}  // namespace

void add_compare(CLI::App& program, Session& session) {
  CLI::App* command =
      program.add_subcommand("compare", "variants of one thing, on an input of your own");
  command->require_subcommand(1);
  add_compare_compose(*command, session);
}

}  // namespace delray::apps
