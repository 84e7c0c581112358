// Reads points or an outline, refines, writes the domain, and says what was reached.
#include "apps/triangulate/refine_points.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <stdexcept>

#include "apps/options/help.h"
#include "apps/options/list.h"
#include "apps/options/numbers.h"
#include "apps/terminal/progress_bar.h"
#include "apps/triangulate/run_statistics.h"
#include "comm/agree_on_failure.h"
#include "delaunay/quality.h"
#include "delaunay/refine.h"
#include "delaunay/write_mesh.h"
#include "files/error.h"
#include "files/format.h"
#include "parallel/arena.h"

namespace delray::apps {
namespace {

constexpr double kDefaultMinAngle = 20;

bool is_outline(const PointInput& input) {
  return !input.is_set() && input.path != "-" &&
         files::identify_format(input.path, input.limits.budget()) == files::Format::poly;
}

delaunay::Outline load_outline(const TriangulateOptions& options) {
  delaunay::Outline outline;
  if (is_outline(options.input)) {
    if (options.input.choice.given()) {
      throw UsageError("an outline is taken with all its points");
    }
    outline = delaunay::read_outline(options.input.path, options.input.limits.budget());
    merge_places(options.input, outline.points);
  } else {
    const delaunay::PointCloud points = load_points(options.input, 2);
    outline.points.has_z = points.has_z;
    outline.points.positions = points.positions;
    outline.points.geographic = points.geographic;
  }
  check_output_of(options.output, options.input, outline.points);
  return outline;
}

// As many as memory holds, with their triangles, queues and what is written.
std::size_t most_points(const TriangulateOptions& options) {
  constexpr std::uint64_t kBytesOfRefinedPoint = 320;
  return static_cast<std::size_t>(
      std::max<std::uint64_t>(1, options.input.limits.budget().left() / kBytesOfRefinedPoint));
}

bool has_ranks(const Session& session, const TriangulateOptions& options) {
  return options.launch.ranks > 1 || session.processes > 1;
}

delaunay::RefineOptions refine_options(Session& session, const TriangulateOptions& options) {
  delaunay::RefineOptions how;
  how.min_angle = options.refinement.min_angle.value_or(kDefaultMinAngle);
  how.max_area = options.refinement.max_area.value_or(0);
  if (!options.refinement.method.empty()) how.method = options.refinement.method;
  how.max_points = most_points(options);
  how.threads = options.how.threads;
  how.progress = &session.progress;
  return how;
}

// What `refine` gives. Throws FileErrors in place of its exceptions.
template <class Refine>
delaunay::Refined with_file_errors(const TriangulateOptions& options, const Refine& refine) {
  try {
    return refine();
  } catch (const std::length_error& error) {
    throw files::FileError(files::Cause::memory, options.input.path, "",
                           fmt::format("{}, which is all that --memory ({}) holds", error.what(),
                                       files::bytes_text(options.input.limits.budget().limit())));
  } catch (const std::invalid_argument& error) {
    throw files::FileError(files::Cause::input, options.input.path, "", error.what());
  }
}

double largest_area(const std::vector<glm::dvec3>& points,
                    const delaunay::Triangulation& triangles) {
  double largest = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const glm::dvec2 a = points[triangles.vertices[3 * t]],
                     b = glm::dvec2(points[triangles.vertices[3 * t + 1]]) - a,
                     c = glm::dvec2(points[triangles.vertices[3 * t + 2]]) - a;
    largest = std::max(largest, (b.x * c.y - b.y * c.x) / 2);
  }
  return largest;
}

Json refinement_json(const delaunay::Refined& refined, const delaunay::Quality& quality,
                     double largest) {
  const delaunay::RefineCounts& counts = refined.counts;
  Json corners = Json::array();
  for (const delaunay::SmallCorner& corner : refined.small_corners) {
    const glm::dvec3& p = refined.points[corner.row];
    corners.push_back({{"row", corner.row}, {"x", p.x}, {"y", p.y}, {"degrees", corner.degrees}});
  }
  return {{"points", refined.points.size()},
          {"on_segments", counts.on_segments},
          {"inside", counts.inside},
          {"crossings", counts.crossings},
          {"segments", refined.segments.size()},
          {"min_angle", quality.min_angle},
          {"max_angle", quality.max_angle},
          {"mean_min_angle", quality.mean_min_angle},
          {"max_area", largest},
          {"excepted", counts.excepted},
          {"too_fine", counts.too_fine},
          {"denied", counts.denied},
          {"small_corners", corners}};
}

Json ranks_json(const delaunay::Refined& refined) {
  Json ranks = Json::array();
  for (const delaunay::RefineRank& rank : refined.ranks) {
    ranks.push_back({{"rank", ranks.size()},
                     {"triangles", rank.triangles},
                     {"most_triangles", rank.most_triangles},
                     {"points", rank.points},
                     {"fetched", rank.fetched},
                     {"requests", rank.requests},
                     {"denials", rank.denials},
                     {"returned", rank.returned},
                     {"messages", rank.messages},
                     {"bytes", rank.bytes},
                     {"waiting_seconds", rank.waiting_seconds}});
  }
  return ranks;
}

void tell(const TriangulateOptions& options, const delaunay::Refined& refined,
          const delaunay::Quality& quality, double largest) {
  const delaunay::RefineCounts& counts = refined.counts;
  spdlog::info(
      "{} points added ({} on segments); angles from {:.2f} to {:.2f} degrees, largest area {:.6g}",
      counts.on_segments + counts.inside + counts.crossings, counts.on_segments, quality.min_angle,
      quality.max_angle, largest);
  if (counts.crossings > 0) {
    spdlog::warn("{}: segments cross {} times; they got points there", options.input.path,
                 counts.crossings);
  }
  if (counts.excepted > 0) {
    spdlog::warn(
        "{}: {} triangles at {} corners of less than 60 degrees have smaller angles (--stats lists "
        "the corners)",
        options.input.path, counts.excepted, refined.small_corners.size());
  }
  if (counts.too_fine > 0) {
    spdlog::warn("{}: {} triangles or segments are too fine for double precision to be cut",
                 options.input.path, counts.too_fine);
  }
}

// Writes the mesh and the statistics of what is refined.
void write_refined(const TriangulateOptions& options, delaunay::Outline& outline,
                   delaunay::Refined& refined, Seconds seconds) {
  Stopwatch watch;
  const std::size_t given = outline.points.size();
  delaunay::Triangulation domain = domain_of(refined);
  domain.hull_facets = hull_facets(domain).size() / 2;
  const delaunay::Quality reached = quality(delaunay::view(refined.points), domain);
  const double largest = largest_area(refined.points, domain);
  const delaunay::Triangulation& result = options.refinement.whole ? refined.triangulation : domain;
  warn_of_no_simplices(options, result.size());
  Json statistics = statistics_of(options, given, result, result.size(), hash(result), seconds);
  add_phases({}, statistics);
  tell_no_choices(statistics);
  statistics["options"].update(
      {{"method", "refine"},
       {"refinement", options.refinement.method.empty() ? "auto" : options.refinement.method},
       {"min_angle", options.refinement.min_angle.value_or(kDefaultMinAngle)},
       {"max_area", options.refinement.max_area.value_or(0)},
       {"whole", options.refinement.whole}});
  statistics["refinement"] = refinement_json(refined, reached, largest);
  if (!refined.ranks.empty()) {
    statistics["options"]["ranks"] = refined.ranks.size();
    statistics["refinement"]["rounds"] = refined.counts.rounds;
    statistics["refinement"]["ranks"] = ranks_json(refined);
  }
  outline.points.positions = std::move(refined.points);
  add_output(write_triangulation(options.output, options.input, outline.points, result, {}),
             statistics);
  statistics["seconds"]["write"] = watch.lap();
  write_statistics(options.statistics, statistics);
  tell_result(2, outline.points.size(), result.distinct, result.size(), seconds.triangulate);
  refined.points.clear();
  tell(options, refined, reached, largest);
}

// Only one process has the points.
int refine_over_ranks(Session& session, const TriangulateOptions& options) {
  Stopwatch watch;
  Seconds seconds;
  delaunay::Outline outline;
  if (session.first_process) outline = load_outline(options);
  seconds.read = watch.lap();
  const ProgressBar bar(session, "refine");
  session.progress.start(0);
  const parallel::AllowThreads allowed(std::max(1, options.launch.ranks) * options.how.threads);
  run_ranks(session, options.launch, options.input.paths, [&](comm::Communicator& communicator) {
    Stopwatch own_watch;
    std::exception_ptr failure;
    delaunay::Refined refined;
    try {
      refined = with_file_errors(
          options, [&] { return refine(communicator, outline, refine_options(session, options)); });
    } catch (const files::FileError&) {  // of all ranks
      failure = std::current_exception();
    }
    comm::agree_on_failure(communicator, failure);
    comm::all_or_none(communicator, comm::Phase::other, [&] {
      if (communicator.rank() != 0) return;
      seconds.triangulate = own_watch.lap();
      write_refined(options, outline, refined, seconds);
    });
  });
  return kDone;
}

}  // namespace

bool is_refined(const TriangulateOptions& options) {
  return options.refinement.min_angle || options.refinement.max_area;
}

void add_refine_options(CLI::App& command, RefinementChoice& choice) {
  command
      .add_option("--min-angle", choice.min_angle,
                  "Add points until no triangle has a smaller angle, in degrees up to 30 (up to "
                  "20.7 that ends for certain); the segments of a .poly are kept, and 0 adds "
                  "points to them alone")
      ->check(number_between(0, delaunay::kLargestMinAngle));
  command
      .add_option("--max-area", choice.max_area,
                  "Add points until no triangle is larger, with --min-angle 20 by default")
      ->check(positive_number());
  command.add_option("--refinement", choice.method,
                     "How points are added (--list describes the methods; default: auto)");
  std::vector<std::string> names = names_in(delaunay::refinement_methods());
  names.insert(names.begin(), "auto");
  choose_from(command, "--refinement", names);
  command
      .add_flag("--whole", choice.whole,
                "Write the triangles outside of a refined outline and in its holes, too")
      ->group(group::kOutput);
}

void check_refine(const Session& session, TriangulateOptions& options) {
  const delaunay::Options defaults;
  const delaunay::Options& how = options.how;
  if (how.dim != 2) throw UsageError("--min-angle and --max-area are for the plane, --dim 2");
  if (chooses_insertion(how) || how.seed != defaults.seed || options.makers || options.max_error ||
      !options.distributed.empty()) {
    throw UsageError(
        fmt::format("--min-angle and --max-area leave no choice of {}, of seed, makers, max-error "
                    "and distributed",
                    kInsertionChoices));
  }
  if (options.tiles.given()) throw UsageError("--min-angle and --max-area: not with tiles");
  const std::string& method = options.refinement.method;
  if (has_ranks(session, options) && !method.empty() && method != "auto" &&
      !find_entry(delaunay::refinement_methods(), method, "--refinement").distributed) {
    throw UsageError("--refinement " + method + ": not with several ranks");
  }
  check_output(options.output, options.input, how.dim);
  check(session, options.launch);
  options.how.threads = threads_per_rank(
      options.launch, session.under_mpi ? processes_here() : std::max(1, options.launch.ranks));
  check_output_paths(options.output, options.statistics, options.input.paths);
}

int refine_points(Session& session, const TriangulateOptions& options) {
  if (has_ranks(session, options)) return refine_over_ranks(session, options);
  const parallel::AllowThreads allowed(options.how.threads);
  parallel::Arena arena(options.how.threads);
  return arena.execute([&] {
    Stopwatch watch;
    Seconds seconds;
    delaunay::Outline outline = load_outline(options);
    seconds.read = watch.lap();
    delaunay::Refined refined;
    {
      const ProgressBar bar(session, "refine");
      session.progress.start(0);
      refined = with_file_errors(options,
                                 [&] { return refine(outline, refine_options(session, options)); });
    }
    seconds.triangulate = watch.lap();
    write_refined(options, outline, refined, seconds);
    return kDone;
  });
}

}  // namespace delray::apps
