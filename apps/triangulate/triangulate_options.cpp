// The options of `triangulate`, and what they demand of each other.
#include "apps/triangulate/triangulate_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <stdexcept>
#include <vector>

#include "apps/families.h"
#include "apps/input/point_choice.h"
#include "apps/options/help.h"
#include "apps/options/list.h"
#include "apps/options/numbers.h"
#include "apps/triangulate/beyond_space.h"
#include "apps/triangulate/refine_points.h"
#include "delaunay/distributed.h"
#include "delaunay/improve.h"
#include "delaunay/methods.h"

namespace delray::apps {
namespace {

// Throws UsageError for options that mean nothing to the insertion that is bounded by an error.
void require_plain(const TriangulateOptions& options) {
  const delaunay::Options defaults;
  const delaunay::Options& how = options.how;
  if (how.dim != 2) throw UsageError("--max-error is for terrains, which are --dim 2");
  if (chooses_insertion(how) || how.seed != defaults.seed || options.makers) {
    throw UsageError(
        fmt::format("--max-error leaves no choice of {}, of seed and makers", kInsertionChoices));
  }
}

// Throws UsageError for options that mean nothing to a mesh that is improved.
void check_improve(const Session& session, TriangulateOptions& options) {
  const delaunay::Options defaults;
  const delaunay::Options& how = options.how;
  if (!options.input.path.empty()) {
    throw UsageError("--improve: the points are those of " + options.improve + "; not " +
                     options.input.path);
  }
  if (chooses_insertion(how) || how.seed != defaults.seed || options.makers || options.max_error ||
      !options.distributed.empty() || options.input.choice.given() || options.input.terrain_rgb ||
      !options.input.duplicates.empty() || !options.launch.record.empty()) {
    throw UsageError(
        fmt::format("--improve leaves no choice of {}, of seed, makers, max-error, distributed, "
                    "duplicates, record and of points",
                    kInsertionChoices));
  }
  if (is_tiled(session, options)) throw UsageError("--improve: not with several ranks or tiles");
  if (how.dim > 3) throw UsageError("--improve: meshes are of 2 or 3 dimensions");
  options.input.path = options.improve;
  options.input.paths = {options.improve};
  check_output(options.output, options.input, how.dim);
  check(session, options.launch);
  options.how.threads = threads_per_rank(options.launch, 1);
  check_output_paths(options.output, options.statistics, {options.improve});
}

// Names in a table, or that which leaves the choice to the program.
template <class Table>
void choose(CLI::App& command, const char* option, const Table& table) {
  std::vector<std::string> names = names_in(table);
  names.insert(names.begin(), "auto");
  choose_from(command, option, names,
              {"", [](const std::string& name) { return name == "none"; }});  // as statistics say
}

void add_choices(CLI::App& command) {
  choose(command, "--method", delaunay::methods());
  choose(command, "--location", delaunay::locations());
  choose(command, "--split", delaunay::splits());
  choose(command, "--order", delaunay::orders());
  choose(command, "--deadlocks", delaunay::deadlock_strategies());
  choose(command, "--locks", delaunay::lock_kinds());
  choose(command, "--unlock", delaunay::unlock_times());
}

// Throws UsageError for options that mean nothing to the distributed method.
void require_distributed(const TriangulateOptions& options) {
  const auto& method =
      find_entry(delaunay::distributed_methods(), options.distributed, "--distributed");
  if (options.tiles.given())
    throw UsageError(
        "--tiles, --scratch and --resume: not with --distributed, which has an area a rank");
  const delaunay::Options& how = options.how;
  if (!method.triangulates_parts && chooses_insertion(how)) {
    throw UsageError(fmt::format("--distributed {} leaves no choice of {}", options.distributed,
                                 kInsertionChoices));
  }
  if (std::ranges::find(method.dims, how.dim) == method.dims.end()) {
    throw UsageError("--distributed " + options.distributed + ": not in " +
                     std::to_string(how.dim) + "D");
  }
}

// Throws UsageError for what the method makes no use of.
void require_used(const TriangulateOptions& options) {
  const delaunay::Method& method = method_of(options.how);
  const delaunay::Options defaults;
  if (options.how.queue != defaults.queue && !method.queued) {
    throw UsageError(fmt::format("--queue has no effect with method {}", method.name));
  }
  if (options.how.searching != defaults.searching && !method.queued) {
    throw UsageError(fmt::format("--searching has no effect with method {}", method.name));
  }
  const bool by_areas =
      options.distributed.empty() ||
      find_entry(delaunay::distributed_methods(), options.distributed, "--distributed")
          .triangulates_parts;
  if (options.how.seed != defaults.seed && !method.seeded && by_areas) {
    throw UsageError(fmt::format("--seed has no effect with method {}", method.name));
  }
}

}  // namespace

bool chooses_insertion(const delaunay::Options& how) {
  const delaunay::Options defaults;
  return how.method != defaults.method || how.location != defaults.location ||
         how.split != defaults.split || how.order != defaults.order ||
         how.deadlocks != defaults.deadlocks || how.locks != defaults.locks ||
         how.unlock != defaults.unlock || how.searching != defaults.searching ||
         how.queue != defaults.queue;
}

bool takes_parts(const TriangulateOptions& options) {
  return options.output.kind() == OutputKind::none || options.output.takes_parts(options.how.dim);
}

bool is_tiled(const Session& session, const TriangulateOptions& options) {
  return options.tiles.given() || !options.distributed.empty() || options.launch.ranks > 1 ||
         session.processes > 1;
}

void check(const Session& session, TriangulateOptions& options) {
  const OutputKind output = options.output.kind();
  if (output == OutputKind::none && options.statistics.empty()) {
    throw UsageError("triangulate: -o MESH is missing");
  }
  if (!options.improve.empty()) {
    if (options.refinement.given()) {
      throw UsageError("--improve adds no points: not with --min-angle and --max-area");
    }
    return check_improve(session, options);
  }
  if (!options.criterion.empty()) {
    throw UsageError("--criterion: only --improve has a criterion of flips");
  }
  if (options.input.path.empty()) throw UsageError("triangulate: POINTS is missing");
  if (is_refined(options)) return check_refine(session, options);
  if (options.refinement.given()) {
    throw UsageError("--refinement and --whole: only with --min-angle or --max-area");
  }
  if (is_beyond_space(options)) return check_beyond_space(session, options);
  check_output(options.output, options.input, options.how.dim);
  if (options.max_error && output == OutputKind::folder) {
    throw UsageError("--max-error: a simplified terrain goes to one file");
  }
  if (!takes_parts(options) && (!options.tiles.scratch.empty() || options.tiles.resume)) {
    throw UsageError(
        "--scratch and --resume: such a mesh in one file is made in memory; -o "
        "FOLDER/, .vtu and triangles as .ply are not");
  }
  if (output == OutputKind::file && options.tiles.resume) {
    throw UsageError("--resume: a mesh in one file is made in one run; -o FOLDER/ is not");
  }
  if (output == OutputKind::raster && options.tiles.resume) {
    throw UsageError("--resume: a raster is made in one run");
  }
  if (options.makers && (output != OutputKind::file || !options.output.path.ends_with(".vtu"))) {
    throw UsageError("--makers: only a mesh in a .vtu file can tell them");
  }
  if (is_tiled(session, options) && (options.max_error || options.makers)) {
    throw UsageError((options.max_error ? std::string("--max-error") : std::string("--makers")) +
                     ": not with several ranks or tiles");
  }
  if (!options.distributed.empty()) require_distributed(options);
  if (options.max_error && options.tiles.given()) throw UsageError("--max-error: not with tiles");
  check(session, options.launch);
  delaunay::Options& how = options.how;
  how.threads = session.under_mpi
                    ? threads_per_rank(options.launch, processes_here())
                    : threads_per_rank(options.launch, std::max(1, options.launch.ranks));
  if (options.max_error) {
    require_plain(options);
    // Several threads keep other points, so that they have to be asked for.
    if (options.launch.threads == 0) how.threads = 1;
  }
  try {
    how = resolve(how);
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
  if (!options.max_error) require_used(options);
  check_scratch(options.tiles);
  check_output_paths(options.output, options.statistics, options.input.paths);
}

void add_triangulate_options(CLI::App& command, TriangulateOptions& options) {
  add_points_argument(command, "POINTS", options.input,
                      "Files of points (delray info --list names the formats), folders of such or "
                      "patterns; - for standard input");
  add_output_options(command, options.output);
  command
      .add_option("--dim", options.how.dim,
                  "Dimension: 2, over x and y, where z is kept as height (default), 3, or 4 to 6 "
                  "from .node to .node and .ele")
      ->check(one_of({"2", "3", "4", "5", "6"}));
  command.add_option("--method", options.how.method,
                     "Method (--list describes them; default: auto, the fastest of the dimension)");
  command.add_option(
      "--location", options.how.location,
      "How the simplex that a new point lies in is found: dag, hierarchy, walk or auto (default)");
  command.add_option(
      "--split", options.how.split,
      "Which thread inserts which points: random, slabs, distance, curve or auto (default)");
  command.add_option("--order", options.how.order,
                     "Order of insertion: brio, hilbert, random or auto (default)");
  command.add_option(
      "--deadlocks", options.how.deadlocks,
      "How the optimistic method ends deadlocks: detection, priorities or auto (default)");
  command.add_option(
      "--locks", options.how.locks,
      "What the pessimistic, optimistic and burglary methods lock by: atomic, mutex, "
      "striped or auto (default)");
  command.add_option(
      "--unlock", options.how.unlock,
      "When the optimistic and burglary methods unlock simplices: end, early or auto (default)");
  command
      .add_option("--searching", options.how.searching,
                  "Threads of the batch method that locate points, fewer than --threads (default: "
                  "as many as keep the inserting thread busy, by measured times)")
      ->transform(count_between(1, delaunay::kMostThreads));
  command
      .add_option(
          "--queue", options.how.queue,
          "Capacity of the batch method's queue in points (default: by the number of points)")
      ->transform(any_count());
  command
      .add_option("--max-error", options.max_error,
                  "Simplify a terrain: keep just enough points for all others to be within this "
                  "above or below the mesh, in units of z; several --threads keep a few more")
      ->check(non_negative_number());
  command
      .add_option("--improve", options.improve,
                  "Mesh, with its points, to be made Delaunay by flips, in place of POINTS")
      ->type_name("MESH")
      ->group(group::kInput);
  command.add_option("--criterion", options.criterion,
                     "What --improve flips by: circle (default), or angle in 2D");
  choose_from(command, "--criterion", names_in(delaunay::criteria()));
  add_refine_options(command, options.refinement);
  add_launch_options(command, options.launch);
  add_tiles_options(command, options.tiles);
  command
      .add_option("--distributed", options.distributed,
                  "How ranks share one triangulation (--list describes the methods; default: "
                  "tiles)")
      ->group(group::kParallel);
  choose_from(command, "--distributed", names_in(delaunay::distributed_methods()));
  command.add_option("--seed", options.how.seed, "Seed of all random numbers (default: 1)")
      ->transform(any_count());
  command
      .add_option("--stats", options.statistics,
                  "Statistics as JSON to this file; - for standard output")
      ->type_name("FILE")
      ->group(group::kOutput);
  command
      .add_flag("--makers", options.makers,
                "Tell which thread made each simplex, as \"thread\" in a .vtu")
      ->group(group::kOutput);
  command.add_flag("--list", options.list, "List the methods, and what their options choose from")
      ->group(group::kOutput);
  add_choices(command);
  add_point_options(command, options.input);
}

}  // namespace delray::apps
