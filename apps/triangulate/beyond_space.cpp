// From .node to .node and .ele, by delaunay::triangulate_dimensions().
#include "apps/triangulate/beyond_space.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <array>

#include "apps/options/outputs.h"
#include "apps/terminal/progress_bar.h"
#include "apps/triangulate/run_statistics.h"
#include "delaunay/dimensions.h"
#include "files/format.h"

namespace delray::apps {
namespace {

// Measured on uniform points, from 4 dimensions on.
constexpr std::array<std::uint64_t, 3> kBytesOfPoint = {3'000, 20'000, 180'000};

delaunay::PointTable load_table(const TriangulateOptions& options) {
  const auto memory = options.input.limits.budget();
  delaunay::PointTable points = delaunay::read_point_table(options.input.path, memory);
  if (points.dim != options.how.dim) {
    throw UsageError(fmt::format("--dim {}: the points of {} have {} coordinates", options.how.dim,
                                 options.input.path, points.dim));
  }
  memory.require(points.size() * kBytesOfPoint[static_cast<std::size_t>(points.dim) - 4],
                 options.input.path, fmt::format("triangulation of {} points", points.size()));
  return points;
}

}  // namespace

void check_beyond_space(const Session& session, const TriangulateOptions& options) {
  const delaunay::Options& how = options.how;
  const std::string dim = fmt::format("--dim {}", how.dim);
  const auto is_node = [](const std::string& path) {
    return files::format_of_suffix(path) == files::Format::node;
  };
  if (options.input.paths.size() > 1 || !is_node(options.input.path)) {
    throw UsageError(
        fmt::format("{}: points are those of one .node file, not {}", dim, options.input.path));
  }
  if (options.output.kind() != OutputKind::none && !is_node(options.output.path)) {
    throw UsageError(
        fmt::format("{}: simplices go to .node and .ele, not {}", dim, options.output.path));
  }
  if (chooses_insertion(how) || options.makers || options.max_error ||
      !options.distributed.empty() || options.input.choice.given() || options.input.terrain_rgb ||
      options.input.cell_size > 0 || !options.input.duplicates.empty() ||
      !options.launch.record.empty() || options.launch.threads > 0) {
    throw UsageError(
        fmt::format("{} leaves no choice of {}, of threads, makers, max-error, distributed, "
                    "duplicates, record and of points",
                    dim, kInsertionChoices));
  }
  if (is_tiled(session, options)) throw UsageError(dim + ": not with several ranks or tiles");
  check_outputs({{"-o", options.output.path}, {"--stats", options.statistics}},
                options.input.paths);
}

int triangulate_beyond_space(Session& session, const TriangulateOptions& options) {
  Stopwatch watch;
  Seconds seconds;
  const delaunay::PointTable points = load_table(options);
  seconds.read = watch.lap();
  delaunay::Triangulation result;
  {
    const ProgressBar bar(session, "triangulate");
    session.progress.start(points.size());
    result = triangulate_dimensions(points.view(), points.dim, options.how.seed, &session.progress);
  }
  seconds.triangulate = watch.lap();
  warn_of_no_simplices(options, result.size());
  Json statistics =
      statistics_of(options, points.size(), result, result.size(), hash(result), seconds);
  add_phases({}, statistics);
  tell_no_choices(statistics);
  statistics["options"].update({{"method", "cavity"}, {"threads", 1}});
  if (!options.output.path.empty()) write_table_mesh(options.output.path, points, result);
  statistics["seconds"]["write"] = watch.lap();
  write_statistics(options.statistics, statistics);
  tell_result(points.dim, points.size(), result.distinct, result.size(), seconds.triangulate);
  return kDone;
}

}  // namespace delray::apps
