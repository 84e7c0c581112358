// delray verify: is this mesh the Delaunay triangulation of these points?
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>

#include "apps/commands.h"
#include "apps/outputs.h"
#include "apps/point_input.h"
#include "apps/statistics.h"
#include "delaunay/read_mesh.h"
#include "delaunay/verify.h"
#include "files/error.h"

namespace delray::apps {
namespace {

struct VerifyOptions {
  std::string mesh, statistics;
  PointInput points;
  int dim = 2;
  bool canonical = false;
};

// Throws FileError where the vertices of the mesh are not the points.
void require_same_points(const VerifyOptions& options, const delaunay::PointCloud& vertices,
                         const delaunay::PointCloud& points) {
  const auto row = delaunay::first_different_row(delaunay::view(vertices.positions),
                                                 delaunay::view(points.positions), options.dim);
  if (!row) return;
  throw files::FileError(files::Cause::input, options.mesh, fmt::format("vertex {}", *row),
                         *row < vertices.size() && *row < points.size()
                             ? fmt::format("is not row {} of {}", *row, options.points.path)
                             : fmt::format("{} vertices, but {} has {} points", vertices.size(),
                                           options.points.path, points.size()));
}

Json statistics_of(const VerifyOptions& options, const delaunay::PointMesh& mesh,
                   const delaunay::Verdict& verdict) {
  return {
      {"schema", "delray.verify/1"},
      {"mesh", options.mesh},
      {"points", options.points.path},
      {"dim", options.dim},
      {"result",
       {{"points", mesh.points.size()},
        {"distinct", verdict.distinct},
        {"simplices", mesh.triangulation.size()},
        {"hash", to_string(hash(mesh.triangulation))},
        {"valid", verdict.valid},
        {"delaunay", verdict.delaunay},
        {"canonical", verdict.canonical},
        {"simplex", verdict.simplex ? Json(*verdict.simplex) : Json(nullptr)},
        {"reason", verdict.reason}}},
  };
}

int run(const VerifyOptions& options) {
  if (options.mesh.empty()) throw UsageError("verify: MESH is missing");
  if (options.points.path.empty()) throw UsageError("verify: --points POINTS is missing");
  check_outputs({{"--stats", options.statistics}}, {options.mesh, options.points.path});
  const delaunay::PointMesh mesh =
      delaunay::read_mesh(options.mesh, options.points.limits.budget());
  if (mesh.triangulation.dim != options.dim && mesh.triangulation.size() > 0) {
    throw UsageError(fmt::format("--dim {}: {} has simplices of dimension {}", options.dim,
                                 options.mesh, mesh.triangulation.dim));
  }
  require_same_points(options, mesh.points, load_points(options.points, options.dim));
  const delaunay::Verdict verdict = verify_simplices(
      options.dim, delaunay::view(mesh.points.positions), mesh.triangulation.vertices);

  const bool good = options.canonical ? verdict.canonical : verdict.delaunay;
  const std::string where = verdict.simplex ? fmt::format("simplex {}: ", *verdict.simplex) : "";
  write_statistics(options.statistics, statistics_of(options, mesh, verdict));
  if (!verdict.reason.empty()) {
    if (good) {
      spdlog::info("{}{}", where, verdict.reason);
    } else {
      spdlog::error("{}: {}{}", options.mesh, where, verdict.reason);
    }
  }
  if (options.statistics != "-") {
    fmt::print("valid: {}\ndelaunay: {}\ncanonical: {}\n", verdict.valid ? "yes" : "no",
               verdict.delaunay ? "yes" : "no", verdict.canonical ? "yes" : "no");
  }
  return good ? kDone : kNotVerified;
}

}  // namespace

void add_verify(CLI::App& program, Session& session) {
  CLI::App* command =
      program.add_subcommand("verify", "check a triangulation against its points, exactly");
  const auto options = std::make_shared<VerifyOptions>();
  command->add_option("MESH", options->mesh, "the triangulation");
  command->add_option("--points", options->points.path, "the points that it should be of");
  command->add_option("--dim", options->dim, "2 (default) or 3")->check(CLI::IsMember({2, 3}));
  command->add_flag(
      "--canonical", options->canonical,
      "also demand the choice among cocircular or cospherical points that delray makes");
  command->add_option("--stats", options->statistics, "write the verdict as JSON; - for stdout");
  add_point_options(*command, options->points);
  add_common_options(*command, session,
                     "verify mesh.ply --points points.las\n"
                     "verify mesh.off --points points.csv --canonical --stats -");
  command->callback([&session, options] { session.run = [options] { return run(*options); }; });
}

}  // namespace delray::apps
