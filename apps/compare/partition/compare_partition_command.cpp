// delray compare partition: the command line.
#include <CLI/CLI.hpp>

#include "apps/compare/compare_commands.h"
#include "apps/compare/partition/compare_partition.h"
#include "apps/compare/partition/partition_figures.h"
#include "apps/compare/partition/partition_report.h"
#include "apps/families.h"
#include "apps/options/help.h"
#include "apps/options/list.h"
#include "apps/options/numbers.h"
#include "apps/render/options/render_options.h"
#include "comm/network.h"
#include "raster/strategies.h"

namespace delray::apps {
namespace {

int list_for_partition() {
  list_partitions();
  list_strategies();
  list_networks();
  return kDone;
}

int run(Session& session, const CLI::App& command, PartitionRequest request) {
  if (request.list) return list_for_partition();
  if (session.under_mpi)
    throw UsageError("compare partition: its ranks take turns in one process; leave out mpirun");
  refuse_if_idle("--bezel", command, request.render);
  // The most ranks take a minute more.
  if (request.quick && command.count("--ranks") == 0) request.ranks.pop_back();
  return run_scene_comparison(
      session, command, request, [&](const Prepared& prepared, parallel::Progress& progress) {
        const auto comparison = std::make_shared<const PartitionComparison>(
            compare_partition(request, prepared, progress));
        return Found{
            partition_table(comparison->rows), partition_statistics(request, prepared, *comparison),
            comparison->unfinished,
            [&, comparison] { return partition_report(session, request, prepared, *comparison); }};
      });
}

}  // namespace

void add_compare_partition(CLI::App& compare, Session& session) {
  CLI::App* command = compare.add_subcommand(
      "partition", "Compare partitions of the screen among ranks: balance, overlap and times");
  const auto request = std::make_shared<PartitionRequest>();
  request->ranks = {2, 4, 8, 16, 32, 64, 256, 1024};
  add_scene_comparison_options(*command, *request,
                               "(default: 2,4,8,16,32,64,256,1024, "
                               "the last not with --quick); of more than 64 work is "
                               "counted and times are predicted");
  add_options({"--wall", "--bezel"}, *command, request->render);
  command
      ->add_option("--regions", request->regions,
                   "Numbers of regions per rank to compare, separated by commas (default: 1,2,4); "
                   "all but the first are compared only for the highest number of ranks up to 16")
      ->group(group::kSharing)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->transform(count_between(1, 64));
  command
      ->add_option("--partition", request->partitions,
                   "Partitions to compare, separated by commas (default: all)")
      ->group(group::kSharing)
      ->delimiter(',')
      ->allow_extra_args(false);
  choose_from(*command, "--partition", names_in(loadbalance::partitioners()));
  add_comparison_options(*command, *request, "Measure three frames of each",
                         "partitions, strategies and networks");
  add_common_options(*command, session,
                     "compare partition model.glb -o partition.html\n"
                     "compare partition gen:city --ranks 16,64,1024 --stats partition.json");
  command->callback([&session, request, command] {
    session.run = [&session, request, command] { return run(session, *command, *request); };
  });
}

}  // namespace delray::apps
