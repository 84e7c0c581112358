// delray triangulate: points to a Delaunay triangulation.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <optional>

#include "apps/commands.h"
#include "apps/families.h"
#include "apps/input/point_choice.h"
#include "apps/options/help.h"
#include "apps/output/triangulation_output.h"
#include "apps/statistics.h"
#include "apps/terminal/progress_bar.h"
#include "apps/triangulate/beyond_space.h"
#include "apps/triangulate/improve_mesh.h"
#include "apps/triangulate/refine_points.h"
#include "apps/triangulate/run_statistics.h"
#include "apps/triangulate/triangulate_options.h"
#include "apps/triangulate_distributed.h"
#include "apps/triangulate_parts.h"
#include "apps/triangulate_tiles.h"
#include "apps/triangulation_json.h"
#include "comm/agree_on_failure.h"
#include "delaunay/distributed.h"
#include "delaunay/simplify_terrain.h"
#include "files/error_hint.h"
#include "parallel/arena.h"

namespace delray::apps {
namespace {

// Replaces the points by those that are kept, and the vertices, which are their rows, by their new
// rows.
void keep_rows(const std::vector<std::uint32_t>& kept, delaunay::PointCloud& points,
               delaunay::Triangulation& result) {
  points = select_rows(points, kept);
  for (std::uint32_t& vertex : result.vertices) {
    vertex = static_cast<std::uint32_t>(std::ranges::lower_bound(kept, vertex) - kept.begin());
  }
}

// Collective. What a distributed method took goes to `statistics`.
TiledRun triangulate_with_ranks(comm::Communicator& communicator, const TriangulateOptions& options,
                                const delaunay::PointCloud& points,
                                const delaunay::TileOptions& how, Json& statistics) {
  const bool with_vertices = options.output.kind() != OutputKind::none;
  if (options.distributed.empty()) {
    return triangulate_by_ranks(communicator, points, how, with_vertices);
  }
  delaunay::DistributedOptions distributed{options.distributed, how.partition, how.triangulate};
  distributed.triangulate.statistics = !options.statistics.empty();
  DistributedRun run = triangulate_by_method(communicator, points, distributed, with_vertices);
  statistics["distributed"] = distributed_json(distributed, run);
  return std::move(run.made);
}

// All points, with room to triangulate them. FileErrors (memory) say which outputs need less.
delaunay::PointCloud load_to_triangulate(const TriangulateOptions& options) {
  try {
    delaunay::PointCloud points = load_points(options.input, options.how.dim);
    check_output_of(options.output, options.input, points);
    require_memory_to_triangulate(options.input, points.size(), options.how.dim);
    return points;
  } catch (const files::FileError& error) {
    if (error.cause() != files::Cause::memory || takes_parts(options)) throw;
    throw with_hint(
        error, fmt::format("{} is made in memory: -o FOLDER/, .vtu{} are not", options.output.path,
                           options.how.dim == 2 ? " and .ply" : ""));
  }
}

int run_tiled(Session& session, const TriangulateOptions& options) {
  Stopwatch watch;
  Seconds seconds;
  const delaunay::PointCloud points = load_to_triangulate(options);
  seconds.read = watch.lap();
  delaunay::TileOptions how;
  how.tiles = options.tiles.tiles;
  how.triangulate = options.how;
  how.triangulate.progress = &session.progress;
  const ProgressBar bar(session, "triangulate");
  const parallel::AllowThreads allowed(std::max(1, options.launch.ranks) * options.how.threads);
  run_ranks(session, options.launch, {options.input.path}, [&](comm::Communicator& communicator) {
    Stopwatch own_watch;
    Json distributed;
    const TiledRun made = triangulate_with_ranks(communicator, options, points, how, distributed);
    comm::all_or_none(communicator, comm::Phase::other, [&] {
      if (communicator.rank() != 0) return;
      seconds.triangulate = own_watch.lap();
      const delaunay::Triangulation& result = made.triangulation;
      warn_of_no_simplices(options, made.simplices);
      Json statistics =
          statistics_of(options, points.size(), result, made.simplices, made.hash, seconds);
      statistics["options"].update({{"ranks", communicator.size()}, {"tiles", made.tiles.size()}});
      if (!distributed.is_null()) statistics.update(distributed);
      statistics["rounds"] = made.rounds;
      statistics["tiles"] = tiles_json(made);
      own_watch.lap();
      add_output(write_triangulation(options.output, options.input, points, result, {}),
                 statistics);
      statistics["seconds"]["write"] = own_watch.lap();
      write_statistics(options.statistics, statistics);
      tell_result(result.dim, points.size(), result.distinct, made.simplices, seconds.triangulate);
    });
  });
  return kDone;
}

// Without a mesh nothing but sums need be kept.
int run_in_parts(Session& session, const TriangulateOptions& options) {
  std::optional<RanksOutput> output;
  PartsTask task{options.input, options.launch, options.how, options.tiles, options.output.path};
  if (options.output.kind() != OutputKind::none) {
    OutputFacts facts;
    facts.dim = options.how.dim;
    facts.coordinate_system = coordinate_system_of(options.input);
    facts.bounds = filter_of(options.input.choice).bounds;
    facts.memory = std::min(facts.memory, options.input.limits.budget().limit() / 8);
    facts.scratch = scratch_folder(options.tiles, options.output.path);
    facts.resume = options.tiles.resume;
    facts.file.dim = options.how.dim;
    facts.file.scratch = facts.scratch;
    facts.file.memory = options.input.limits.budget().limit();
    facts.file.threads = options.how.threads;
    facts.file.progress = &session.progress;
    facts.file.ranks = session.under_mpi ? 1 : std::max(1, options.launch.ranks);
    output.emplace(
        options.output, facts,
        session.processes > 1 ? RanksOutput::Ranks::processes : RanksOutput::Ranks::threads);
    task.to = &*output;
    task.disk = options.output.disk_use(options.how.dim);
    constexpr std::uint64_t kBytesOfThread = std::max(delaunay::MeshFolderWriter::kBytesOfThread,
                                                      delaunay::MeshFileWriter::kBytesOfThread);
    // Small tiles take little to write.
    task.kept_free =
        options.output.kind() == OutputKind::raster
            ? facts.memory
            : std::min(kBytesOfThread * static_cast<std::uint64_t>(options.how.threads),
                       options.input.limits.budget().limit() / 8);
  }
  triangulate_in_parts(session, task, [&](const PartsMade& made) {
    const delaunay::PartsResult& result = made.result;
    warn_of_no_simplices(options, result.simplices);
    delaunay::Triangulation counts;
    counts.dim = result.dim;
    counts.distinct = result.distinct;
    counts.hull_facets = result.hull_facets;
    Json statistics = statistics_of(options, result.points, counts, result.simplices, result.hash,
                                    {.read = 0, .triangulate = made.seconds});
    statistics["options"].update({{"ranks", made.ranks}, {"tiles", result.tiles.size()}});
    statistics["rounds"] = result.rounds;
    statistics["seconds"]["write"] = made.write;
    add_output(made.output, statistics);
    statistics["scratch"] = result.scratch;
    statistics["resumed"] = result.resumed;
    statistics.update(tiles_json(result));
    write_statistics(options.statistics, statistics);
    tell_result(result.dim, result.points, result.distinct, result.simplices, made.seconds);
  });
  return kDone;
}

// Whether the input goes through memory in parts, which it says where nobody asked for it.
bool goes_in_parts(const Session& session, const TriangulateOptions& options) {
  if (!options.distributed.empty() || options.makers || options.max_error) {
    return false;
  }
  if (!takes_parts(options)) return false;
  if (is_tiled(session, options)) return true;
  const std::uint64_t needed = memory_beyond_limit(options.input, options.how.dim);
  if (needed == 0) return false;
  spdlog::info("{} would take {}, and {} are allowed (--memory): triangulating in tiles",
               options.input.path, files::bytes_text(needed),
               files::bytes_text(options.input.limits.budget().limit()));
  return true;
}

int run(Session& session, TriangulateOptions options) {
  if (options.list) {
    list_methods();
    list_method_options();
    list_distributed_methods();
    list_criteria();
    list_refinements();
    return kDone;
  }
  check(session, options);
  if (!options.improve.empty()) return improve_mesh(options);
  if (is_refined(options)) return refine_points(session, options);
  if (is_beyond_space(options)) return triangulate_beyond_space(session, options);
  tell_left_out(options.input);
  if (options.output.path == "-" && options.how.dim == 3 &&
      memory_beyond_limit(options.input, options.how.dim) > 0) {
    throw UsageError(
        "-o -: the hull of a mesh that is beyond --memory does not fit a stream; -o FOLDER/ takes "
        "the mesh");
  }
  if (goes_in_parts(session, options)) return run_in_parts(session, options);
  if (is_tiled(session, options)) return run_tiled(session, options);
  delaunay::Options& how = options.how;

  Stopwatch watch;
  Seconds seconds;
  delaunay::PointCloud points = load_to_triangulate(options);
  if (!points.has_z && options.max_error) {
    throw UsageError("--max-error: " + options.input.path + " has no z");
  }
  const std::size_t rows = points.size();
  seconds.read = watch.lap();
  how.statistics = !options.statistics.empty();
  how.created_by = options.makers;
  how.progress = &session.progress;
  delaunay::Result made;
  delaunay::Triangulation& result = made.triangulation;
  std::optional<delaunay::SimplifiedTerrain> simplified;
  {
    const ProgressBar bar(session, "triangulate");
    const parallel::AllowThreads allowed(how.threads);
    parallel::Arena arena(how.threads);
    watch.lap();
    if (options.max_error) {
      simplified = simplify_terrain(delaunay::view(points.positions), *options.max_error,
                                    &session.progress, how.threads);
      result = std::move(simplified->triangulation);
    } else {
      made = arena.execute([&] { return triangulate(delaunay::view(points.positions), how); });
    }
    seconds.triangulate = watch.lap();
  }
  warn_of_no_simplices(options, result.size());
  Json statistics = statistics_of(options, rows, result, result.size(), hash(result), seconds);
  add_phases(made.statistics, statistics);
  statistics["flips"] = flips_json(made.statistics.flips, options.how.dim);
  if (simplified) {
    statistics["options"].update({{"method", "simplify"}, {"max_error", *options.max_error}});
    statistics["result"].update(
        {{"kept", simplified->kept.size()}, {"largest_error", simplified->largest_error}});
    keep_rows(simplified->kept, points, result);
  }
  watch.lap();
  {
    const parallel::AllowThreads allowed(how.threads);
    parallel::Arena arena(how.threads);
    add_output(arena.execute([&] {
      return write_triangulation(options.output, options.input, points, result, made.created_by);
    }),
               statistics);
  }
  statistics["seconds"]["write"] = watch.lap();
  write_statistics(options.statistics, statistics);
  tell_result(how.dim, rows, result.distinct, result.size(), seconds.triangulate);
  if (simplified) {
    spdlog::info("{} points kept, largest error {:.6g}", simplified->kept.size(),
                 simplified->largest_error);
  }
  return kDone;
}

}  // namespace

void add_triangulate(CLI::App& program, Session& session) {
  CLI::App* command =
      program.add_subcommand("triangulate", "Compute the Delaunay triangulation of points");
  const auto options = std::make_shared<TriangulateOptions>();
  add_triangulate_options(*command, *options);
  add_common_options(*command, session,
                     "triangulate points.las -o mesh.ply --dim 2 --duplicates mean\n"
                     "triangulate points.las -o terrain.tif --cell-size 1\n"
                     "triangulate --improve other.off -o mesh.ply\n"
                     "triangulate lake.poly --min-angle 25 --max-area 100 -o lake.node\n"
                     "generate points gauss -n 100000 -o - | delray triangulate - -o mesh.vtu");
  command->callback([&session, options, command] {
    options->dim_given = command->count("--dim") > 0;
    session.run = [&session, options] { return run(session, *options); };
  });
}

}  // namespace delray::apps
