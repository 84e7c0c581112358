// delray compare triangulate: the command line.
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "apps/compare/compare_commands.h"
#include "apps/compare/triangulate/algorithms_report.h"
#include "apps/compare/triangulate/compare_distributed.h"
#include "apps/compare/triangulate/compare_triangulate.h"
#include "apps/compare/triangulate/distributed_figures.h"
#include "apps/compare/triangulate/distributed_report.h"
#include "apps/compare/triangulate/inputs_report.h"
#include "apps/families.h"
#include "apps/input/point_parts_input.h"
#include "apps/options/help.h"
#include "apps/options/list.h"
#include "apps/options/numbers.h"
#include "apps/terminal/progress_bar.h"
#include "delaunay/distributed.h"
#include "delaunay/methods.h"
#include "files/format.h"

namespace delray::apps {
namespace {

// Pictures and scans from the air are terrain; other points with a z are points in space.
bool is_terrain(const PointInput& input) {
  if (input.given()) return true;
  const files::Format format =
      files::identify_format(find_input_files(input).paths.front(), input.limits.budget());
  return format == files::Format::image || format == files::Format::las;
}

delaunay::PointCloud load(const PointInput& input, int& dim) {
  if (dim == 0 && is_terrain(input)) dim = 2;
  if (dim > 0) return load_points(input, dim);
  delaunay::PointCloud points = read_cloud(input);
  dim = points.has_z ? 3 : 2;
  return points;
}

void check_methods(const TriangulateRequest& request, int dim) {
  for (const std::string& name : request.methods) {
    delaunay::Options how;
    how.dim = dim;
    how.method = name;
    resolve(how);  // names those of the dimension
  }
}

// Throws UsageError for options that mean nothing to the methods that are compared.
void check_ranks(TriangulateRequest& request) {
  if (request.ranks.empty() && !request.distributed.empty())
    throw UsageError("compare triangulate: --distributed goes with --ranks");
  if (request.ranks.empty() && !request.network.given.empty())
    throw UsageError("compare triangulate: --network goes with --ranks");
  if (request.ranks.empty()) return;
  request.networks = networks_of(request.network, request.ranks);
  if (!request.threads.empty() || !request.methods.empty()) {
    throw UsageError(
        "compare triangulate: --ranks compares distributed methods, not --method and --threads");
  }
  std::ranges::sort(request.ranks);
  request.ranks.erase(std::unique(request.ranks.begin(), request.ranks.end()), request.ranks.end());
}

// The distributed methods, of the dimension at least one of those that were asked for.
int run_distributed(Session& session, const TriangulateRequest& request,
                    const delaunay::PointCloud& points, int dim) {
  const auto names = delaunay::distributed_methods_for(dim);
  for (const std::string& name : request.distributed) {
    if (std::ranges::find(names, name) == names.end())
      throw UsageError("--distributed " + name + ": not in " + std::to_string(dim) + "D");
  }
  ProgressBar bar(session, "compare");
  const auto comparison = std::make_shared<const DistributedComparison>(
      compare_distributed(request, points, dim, session.progress));
  bar.end();
  return report_results(
      session, request,
      {distributed_table(*comparison), distributed_statistics(request, *comparison),
       comparison->unfinished, [&] { return distributed_report(session, request, *comparison); }});
}

// More points are simulated where somebody asks for ranks.
constexpr std::size_t kMostForRanks = 20'000;

// Whether the page also shows how the methods that ranks have would do.
bool wants_simulated(const ComparedInput& input, std::size_t points) {
  const bool all = input.request.methods.empty() && !input.request.output.empty();
  if (!all || input.comparison.unfinished) return false;
  if (points > kMostForRanks)
    spdlog::info("ranks are simulated with up to {} points, or with --ranks", kMostForRanks);
  return points <= kMostForRanks;
}

DistributedComparison simulated_ranks(TriangulateRequest request,
                                      const delaunay::PointCloud& points, int dim,
                                      parallel::Progress& progress) {
  request.quick = true;
  request.ranks = shown_elements();
  request.ranks.insert(request.ranks.begin(), 1);
  request.networks = {*comm::find_network("hdr-infiniband")};
  try {
    return compare_distributed(request, points, dim, progress);
  } catch (const parallel::Interrupted&) {
    return {};
  }
}

int run(Session& session, TriangulateRequest request) {
  if (request.list) {
    list_methods();
    list_distributed_methods();
    return kDone;
  }
  if (request.input.path.empty()) throw UsageError("compare triangulate: POINTS is missing");
  if (session.under_mpi)
    throw UsageError("compare triangulate: threads are compared, there is nothing for mpirun");
  check_ranks(request);
  check(session, request, request.input.paths);
  std::sort(request.threads.begin(), request.threads.end());
  request.threads.erase(std::unique(request.threads.begin(), request.threads.end()),
                        request.threads.end());
  if (request.dim > 0) check_methods(request, request.dim);
  if (request.each && !request.ranks.empty())
    throw UsageError("compare triangulate: --each compares methods of threads, not --ranks");
  const auto inputs = std::make_shared<std::vector<ComparedInput>>();
  std::vector<delaunay::PointCloud> points;
  for (const std::string& path : request.each ? request.input.paths : std::vector{std::string()}) {
    inputs->push_back({request, {}, {}});
    PointInput& input = inputs->back().request.input;
    if (request.each) {
      input.paths = {path};
      input.name_paths();
    }
    int& dim = inputs->back().comparison.dim = request.dim;
    points.push_back(load(input, dim));
    check_methods(request, dim);
  }
  if (!request.ranks.empty())
    return run_distributed(session, request, points[0], inputs->front().comparison.dim);
  ProgressBar bar(session, "compare");
  for (std::size_t i = 0; i < inputs->size(); ++i) {
    ComparedInput& one = (*inputs)[i];
    if (request.each) spdlog::info("{}", one.request.input.path);
    const int dim = one.comparison.dim;
    one.comparison = compare_triangulate(one.request, points[i], dim, session.progress);
    if (i == 0 && wants_simulated(one, points[0].size()))
      one.simulated = simulated_ranks(one.request, points[0], dim, session.progress);
    if (one.comparison.unfinished) inputs->resize(i + 1);
  }
  bar.end();
  return report_results(
      session, request,
      {inputs_table(*inputs), inputs_statistics(*inputs), inputs->back().comparison.unfinished,
       [&] { return report::page(inputs_page(session, *inputs)); }});
}

}  // namespace

void add_compare_triangulate(CLI::App& compare, Session& session) {
  CLI::App* command = compare.add_subcommand(
      "triangulate", "Compare methods of triangulation: times, speed-up and synchronization");
  const auto request = std::make_shared<TriangulateRequest>();
  add_points_argument(*command, "POINTS", request->input,
                      "Files of points (delray info --list names the formats), folders of such or "
                      "patterns; - for standard input");
  command
      ->add_option(
          "--dim", request->dim,
          "Dimension: 2, over x and y, where z is kept as height, or 3 (default: 3 for points with "
          "a z, but 2 for LAS files and elevation pictures, which are terrain)")
      ->check(one_of({"2", "3"}));
  command->add_flag(
      "--each", request->each,
      "Compare on each of POINTS by itself, on one page, instead of on all as one input");
  command
      ->add_option("--threads", request->threads,
                   "Numbers of threads to compare, separated by commas (default: 1,2,4,8 as far as "
                   "there are cores, and twice the cores if they are few)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->transform(count_between(1, 4096));
  command
      ->add_option("--method", request->methods,
                   "Methods to compare, separated by commas (default: all)")
      ->delimiter(',')
      ->allow_extra_args(false);
  command
      ->add_option("--ranks", request->ranks,
                   "Compare the distributed methods instead, by these numbers of ranks, separated "
                   "by commas, on the simulated machine")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->transform(count_between(1, 4096));
  command
      ->add_option("--distributed", request->distributed,
                   "Distributed methods to compare, separated by commas (default: all)")
      ->delimiter(',')
      ->allow_extra_args(false);
  choose_from(*command, "--distributed", names_in(delaunay::distributed_methods()));
  add_network_option(*command, request->network,
                     "(with --ranks, unless told: "
                     "gigabit-ethernet, 10-gigabit-ethernet, hdr-infiniband, shared-bus)");
  command->add_option("--seed", request->seed, "Seed of all random numbers (default: 1)")
      ->transform(any_count());
  choose_from(*command, "--method", names_in(delaunay::methods()));
  add_point_options(*command, request->input);
  add_comparison_options(*command, *request, "Measure each method three times, slow ones once",
                         "methods");
  add_common_options(*command, session,
                     "compare triangulate points.las -o report.html\n"
                     "compare triangulate points.las --ranks 1,4,16,64 -o ranks.html\n"
                     "compare triangulate uniform.xyz gauss.xyz --each -o inputs.html\n"
                     "compare triangulate model.obj --dim 3 --threads 1,2,4,8 --quick --stats -");
  command->callback([&session, request] {
    session.run = [&session, request] { return run(session, *request); };
  });
}

}  // namespace delray::apps
