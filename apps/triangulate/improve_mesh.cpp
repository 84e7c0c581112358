// Reads a mesh, flips, writes what came of it, and says what could not be flipped.
#include "apps/triangulate/improve_mesh.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "apps/options/list.h"
#include "apps/triangulate/run_statistics.h"
#include "apps/triangulation_json.h"
#include "delaunay/improve.h"
#include "delaunay/read_mesh.h"
#include "files/error.h"
#include "parallel/arena.h"

namespace delray::apps {
namespace {

delaunay::PointMesh load_mesh(const TriangulateOptions& options) {
  delaunay::PointMesh mesh = delaunay::read_mesh(options.improve, options.input.limits.budget());
  const int dim = mesh.triangulation.dim;
  if (options.dim_given && options.how.dim != dim) {
    throw UsageError(fmt::format("--dim {}: {} has simplices of dimension {}", options.how.dim,
                                 options.improve, dim));
  }
  return mesh;
}

// The dimension was not known when options were checked.
void check_output_in_space(TriangulationOutput output) {
  PointInput input;
  input.cell_size = output.cell_size;
  check_output(output, input, 3);
}

delaunay::Improved improve_points(const TriangulateOptions& options,
                                  const delaunay::PointMesh& mesh, delaunay::Criterion criterion) {
  delaunay::Improved made =
      improve(delaunay::view(mesh.points.positions), mesh.triangulation, criterion);
  if (!made.given.valid) {
    throw files::FileError(
        files::Cause::input, options.improve,
        made.given.simplex ? fmt::format("simplex {}", *made.given.simplex) : "",
        made.given.reason + "; only a triangulation of all its points can be improved");
  }
  return made;
}

void tell(const TriangulateOptions& options, const delaunay::Improved& made) {
  if (made.turned > 0) {
    spdlog::info("{} simplices were negatively oriented and are turned", made.turned);
  }
  spdlog::info("{} flips", made.flips.sum());
  if (made.blocked == 0) return;
  spdlog::warn(
      "{}: {} faces are not Delaunay and blocked: no flip can replace them (the first is one of "
      "simplex {} of the result); triangulate the points anew",
      options.improve, made.blocked, *made.first_blocked);
}

}  // namespace

int improve_mesh(const TriangulateOptions& given) {
  TriangulateOptions options = given;
  const auto& criterion =
      find_entry(delaunay::criteria(), options.criterion.empty() ? "circle" : options.criterion,
                 "--criterion");
  const parallel::AllowThreads allowed(options.how.threads);
  parallel::Arena arena(options.how.threads);
  return arena.execute([&] {
    Stopwatch watch;
    Seconds seconds;
    const delaunay::PointMesh mesh = load_mesh(options);
    const int dim = options.how.dim = mesh.triangulation.dim;
    if (std::ranges::find(criterion.dims, dim) == criterion.dims.end()) {
      throw UsageError(fmt::format("--criterion {}: not in {}D", criterion.name, dim));
    }
    if (dim == 3) check_output_in_space(options.output);
    check_output_of(options.output, options.input, mesh.points);
    seconds.read = watch.lap();
    const delaunay::Improved made = improve_points(options, mesh, criterion.criterion);
    seconds.triangulate = watch.lap();
    const delaunay::Triangulation& result = made.triangulation;
    warn_of_no_simplices(options, result.size());
    Json statistics =
        statistics_of(options, mesh.points.size(), result, result.size(), hash(result), seconds);
    add_phases({}, statistics);
    tell_no_choices(statistics);
    statistics["options"].update({{"method", "improve"}, {"criterion", criterion.name}});
    statistics["result"].update({{"flips", flips_json(made.flips, dim)},
                                 {"turned", made.turned},
                                 {"blocked", made.blocked}});
    add_output(write_triangulation(options.output, options.input, mesh.points, result, {}),
               statistics);
    statistics["seconds"]["write"] = watch.lap();
    write_statistics(options.statistics, statistics);
    tell_result(dim, mesh.points.size(), result.distinct, result.size(), seconds.triangulate);
    tell(options, made);
    return kDone;
  });
}

}  // namespace delray::apps
