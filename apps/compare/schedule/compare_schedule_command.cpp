// delray compare schedule: the command line.
#include <CLI/CLI.hpp>

#include "apps/compare/compare_commands.h"
#include "apps/compare/schedule/compare_schedule.h"
#include "apps/compare/schedule/schedule_figures.h"
#include "apps/compare/schedule/schedule_report.h"
#include "apps/families.h"
#include "apps/options/help.h"
#include "apps/options/list.h"
#include "apps/options/numbers.h"
#include "comm/network.h"
#include "raytrace/distribution.h"
#include "raytrace/integrator.h"

namespace delray::apps {
namespace {

int list_for_schedule() {
  list_schedules();
  list_integrators();
  list_networks();
  return kDone;
}

int run(Session& session, const CLI::App& command, ScheduleRequest request) {
  if (request.list) return list_for_schedule();
  if (session.under_mpi)
    throw UsageError("compare schedule: its ranks are simulated in one process; leave out mpirun");
  request.render.engine = Engine::raytrace;
  return run_scene_comparison(
      session, command, request, [&](const Prepared& prepared, parallel::Progress& progress) {
        const auto comparison = std::make_shared<const ScheduleComparison>(
            compare_schedule(session, request, prepared, progress));
        return Found{
            schedule_table(*comparison), schedule_statistics(request, prepared, *comparison),
            comparison->unfinished,
            [&, comparison] { return schedule_report(session, request, prepared, *comparison); }};
      });
}

}  // namespace

void add_compare_schedule(CLI::App& compare, Session& session) {
  CLI::App* command = compare.add_subcommand(
      "schedule", "Compare schedules of the ray tracer: balance, messages and times");
  const auto request = std::make_shared<ScheduleRequest>();
  request->ranks = {2, 4, 8, 16, 32, 64, 128, 256, 1024};
  // Counts are for the first.
  std::ranges::stable_partition(request->networks, [](const comm::NamedNetwork& named) {
    return named.name == "10-gigabit-ethernet";
  });
  add_scene_comparison_options(
      *command, *request,
      "(default: 2,4,8,16,32,64,128,256,1024); all are simulated, and those up "
      "to the number of cores also run");
  add_options({"--integrator", "--spp", "--depth"}, *command, request->render);
  command
      ->add_option(
          "--tile", request->tile,
          "Side in pixels of the tiles that ranks share (default: 16; 3 as Badouel had "
          "them, 1 as Heirich), or cache: as many pixels as fit the first-level data cache")
      ->group(group::kSharing)
      ->transform(block_side());
  command
      ->add_option("--schedule", request->schedules,
                   "Schedules to compare, separated by commas (default: all)")
      ->group(group::kSharing)
      ->delimiter(',')
      ->allow_extra_args(false);
  std::vector<std::string> distributions;
  for (const raytrace::Distribution& distribution : raytrace::distributions())
    if (!distribution.replicated) distributions.emplace_back(distribution.name);
  command
      ->add_option("--data", request->distributions,
                   "Distributions of the scene over up to 16 ranks to compare, separated by commas "
                   "(default: all; none with --quick)")
      ->group(group::kSharing)
      ->delimiter(',')
      ->allow_extra_args(false);
  command
      ->add_option(
          "--cut-level", request->cut_levels,
          "Heights at which the hierarchy of a distributed scene is cut (Caspary), to "
          "compare with --data ray, separated by commas: about 2^N subtrees (default: none)")
      ->group(group::kSharing)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->transform(count_between(0, 24));
  choose_from(*command, "--data", distributions);
  choose_from(*command, "--schedule", names_in(loadbalance::schedules()));
  add_comparison_options(*command, *request, "Measure three frames of each",
                         "schedules, integrators and networks");
  add_common_options(
      *command, session,
      "compare schedule model.glb -o schedule.html --spp 4\n"
      "compare schedule gen:corner --ranks 16,64,1024 --tile 16 --stats schedule.json");
  command->callback([&session, request, command] {
    session.run = [&session, request, command] { return run(session, *command, *request); };
  });
}

}  // namespace delray::apps
