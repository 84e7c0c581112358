// .node and .ele beside the .node of the points, by delaunay::verify_dimensions().
#include "apps/verify/verify_beyond_space.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "apps/verify/verify_json.h"
#include "delaunay/dimensions.h"
#include "files/error.h"
#include "files/format.h"

namespace delray::apps {
namespace {

void check_options(const Session& session, const VerifyOptions& options) {
  const std::string dim = fmt::format("--dim {}", options.dim);
  for (const std::string& path : {options.mesh, options.points.path}) {
    if (files::format_of_suffix(path) != files::Format::node || options.points.paths.size() > 1) {
      throw UsageError(
          fmt::format("{}: meshes and points are .node files with their .ele, not {}", dim, path));
    }
  }
  if (options.complete || options.launch.ranks > 1 || options.launch.threads > 0 ||
      session.processes > 1 || !options.scratch.empty() || options.points.given()) {
    throw UsageError(dim +
                     " leaves no choice of ranks, threads, scratch, complete and of points: every "
                     "point must be a vertex");
  }
}

// Throws FileError unless the vertices are the points, row by row.
void compare_points(const VerifyOptions& options, const delaunay::PointTable& vertices,
                    const delaunay::PointTable& points) {
  if (points.dim != options.dim || vertices.dim != options.dim) {
    throw UsageError(fmt::format("--dim {}: the points have {} coordinates and the vertices {}",
                                 options.dim, points.dim, vertices.dim));
  }
  const std::size_t shared = std::min(vertices.size(), points.size());
  const auto dim = static_cast<std::size_t>(points.dim);
  for (std::size_t i = 0; i < shared * dim; ++i) {
    if (vertices.coordinates[i] == points.coordinates[i]) continue;
    throw files::FileError(
        files::Cause::input, options.mesh, fmt::format("vertex {}", i / dim),
        fmt::format("is not row {} of {}: coordinate {} is {}, not {}", i / dim,
                    options.points.path, i % dim, vertices.coordinates[i], points.coordinates[i]));
  }
  if (vertices.size() != points.size()) {
    throw files::FileError(files::Cause::input, options.mesh, "",
                           fmt::format("has {} vertices, and {} has {} points", vertices.size(),
                                       options.points.path, points.size()));
  }
}

}  // namespace

int verify_beyond_space(const Session& session, const VerifyOptions& options) {
  check_options(session, options);
  const auto memory = options.points.limits.budget();
  const delaunay::TableMesh mesh = delaunay::read_table_mesh(options.mesh, memory);
  compare_points(options, mesh.points, delaunay::read_point_table(options.points.path, memory));
  const delaunay::Verdict verdict =
      verify_dimensions(mesh.points.view(), options.dim, mesh.triangulation.vertices);
  const bool good = options.canonical ? verdict.canonical : verdict.delaunay;
  write_statistics(options.statistics, verify_json(options,
                                                   {{"points", mesh.points.size()},
                                                    {"vertices", mesh.points.size()},
                                                    {"matched", "rows"},
                                                    {"unused", 0},
                                                    {"heights", ""},
                                                    {"distinct", verdict.distinct},
                                                    {"simplices", mesh.triangulation.size()},
                                                    {"hash", to_string(hash(mesh.triangulation))}},
                                                   verdict));
  if (!verdict.reason.empty()) {
    const std::string where = verdict.simplex ? fmt::format("simplex {}: ", *verdict.simplex) : "";
    if (good) {
      spdlog::info("{}{}", where, verdict.reason);
    } else {
      spdlog::error("{}: {}{}", options.mesh, where, verdict.reason);
    }
  }
  if (options.statistics != "-") {
    fmt::print(
        "valid: {}\ndelaunay: {}\ncanonical: {}\nchecked: {} vertices, each the point of its row\n",
        verdict.valid ? "yes" : "no", verdict.delaunay ? "yes" : "no",
        verdict.canonical ? "yes" : "no", mesh.points.size());
  }
  return good ? kDone : kNotVerified;
}

}  // namespace delray::apps
