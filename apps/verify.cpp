// delray verify: is this mesh the Delaunay triangulation of these points?
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <optional>

#include "apps/commands.h"
#include "apps/input/point_input.h"
#include "apps/options/help.h"
#include "apps/options/list.h"
#include "apps/options/outputs.h"
#include "apps/verify/verify_beyond_space.h"
#include "apps/verify/verify_folder.h"
#include "apps/verify/verify_json.h"
#include "apps/verify/verify_pack.h"
#include "delaunay/match_points.h"
#include "delaunay/mesh_folder.h"
#include "delaunay/read_mesh.h"
#include "delaunay/simplify_terrain.h"
#include "delaunay/verify.h"
#include "files/error.h"
#include "packs/pack_reader.h"
#include "parallel/arena.h"

namespace delray::apps {
namespace {

// The way in which the vertices of the mesh were found among the points.
struct Matched {
  const char* how = "rows";              // "coordinates", "32-bit coordinates"
  std::vector<std::uint32_t> rows;       // of each vertex; none where they are numbered alike
  std::size_t points = 0;                // of the file
  std::size_t distinct = 0, unused = 0;  // not known of rows
  // In 2D the result of comparing z, and the first vertex of a simplex with another than its point.
  const char* heights = "";
  std::optional<std::size_t> other_height;
  double height = 0.0;  // of the point that vertex is
  bool by_rows() const { return rows.empty(); }
};

std::string place_of(const glm::dvec3& p, int dim) {
  return dim == 2 ? fmt::format("({}, {})", p.x, p.y) : fmt::format("({}, {}, {})", p.x, p.y, p.z);
}

bool has_heights(const delaunay::PointCloud& cloud) {
  return cloud.has_z &&
         std::ranges::any_of(cloud.positions, [](const glm::dvec3& p) { return p.z != 0.0; });
}

// Vertices of no simplex are other rows of places with several heights, which keep their own.
void compare_heights(const delaunay::PointMesh& mesh, const delaunay::PointCloud& points,
                     Matched& matched) {
  matched.heights = "equal";
  for (const std::uint32_t v : mesh.triangulation.vertices) {
    const double z = points.positions[matched.by_rows() ? v : matched.rows[v]].z;
    if (mesh.points.positions[v].z == z || v >= matched.other_height.value_or(mesh.points.size()))
      continue;
    matched.heights = "different";
    matched.other_height = v;
    matched.height = z;
  }
}

// Throws FileError where a vertex of the mesh is not a point, or might be several. Gives vertices
// with coordinates of 32 bits those of their points.
Matched match_places(const VerifyOptions& options, delaunay::PointMesh& mesh,
                     const delaunay::PointCloud& points) {
  Matched matched;
  const auto vertex_view = delaunay::view(mesh.points.positions);
  const auto point_view = delaunay::view(points.positions);
  const bool rounded = mesh.has_float_coordinates;
  if (!rounded && !delaunay::first_different_row(vertex_view, point_view, options.dim)) {
    return matched;
  }
  const delaunay::PointMatch found =
      delaunay::match_points(vertex_view, point_view,
                             {.dim = options.dim,
                              .as_floats = rounded,
                              .with_z = rounded && points.has_z && has_heights(mesh.points)});
  const auto fail = [&](std::size_t vertex, const std::string& what) {
    throw files::FileError(
        files::Cause::input, options.mesh, fmt::format("vertex {}", vertex),
        fmt::format("{} {}", place_of(mesh.points.positions[vertex], options.dim), what));
  };
  if (found.unknown) fail(*found.unknown, "is none of the points of " + options.points.path);
  if (found.ambiguous) {
    fail(found.ambiguous->vertex,
         fmt::format("may be row {} or row {} of {}, which are equal as 32-bit floats: check a "
                     "mesh with 64-bit coordinates (PLY, OBJ, OFF, VTU, NODE)",
                     found.ambiguous->rows[0], found.ambiguous->rows[1], options.points.path));
  }
  if (rounded) mesh.points = delaunay::select_rows(points, found.rows);
  matched.how = rounded ? "32-bit coordinates" : "coordinates";
  matched.rows = found.rows;
  matched.distinct = found.distinct;
  matched.unused = found.unused;
  return matched;
}

Matched match(const VerifyOptions& options, delaunay::PointMesh& mesh,
              const delaunay::PointCloud& points) {
  const bool mesh_has_heights = has_heights(mesh.points);
  Matched matched = match_places(options, mesh, points);
  matched.points = points.size();
  if (options.dim == 3) return matched;
  if (points.has_z && mesh_has_heights) {
    compare_heights(mesh, points, matched);
  } else if (mesh_has_heights) {
    matched.heights = "not compared: the points have none";
  } else if (has_heights(points)) {
    matched.heights = "not compared: the mesh has none";
  }
  return matched;
}

// With the points' rows as vertices, as `triangulate` counts them.
std::string hash_of(const delaunay::PointMesh& mesh, const Matched& matched) {
  if (matched.by_rows()) return to_string(hash(mesh.triangulation));
  delaunay::Triangulation numbered = mesh.triangulation;
  for (std::uint32_t& vertex : numbered.vertices) vertex = matched.rows[vertex];
  return to_string(hash(numbered));
}

std::string what_was_checked(const delaunay::PointMesh& mesh, const Matched& matched) {
  const std::string heights =
      *matched.heights != '\0' ? fmt::format("; heights are {}", matched.heights) : "";
  if (matched.by_rows()) {
    return fmt::format("{} vertices, each the point of its row{}", mesh.points.size(), heights);
  }
  return fmt::format(
      "{} vertices, each a point by its {}; {} of {} distinct points are no vertex{}",
      mesh.points.size(), matched.how, matched.unused, matched.distinct, heights);
}

// What was checked.
Json checked_json(const delaunay::PointMesh& mesh, const Matched& matched,
                  const delaunay::Verdict& verdict) {
  return {{"points", matched.points},
          {"vertices", mesh.points.size()},
          {"matched", matched.how},
          {"unused", matched.unused},
          {"heights", matched.heights},
          {"distinct", matched.by_rows() ? verdict.distinct : matched.distinct},
          {"simplices", mesh.triangulation.size()},
          {"hash", hash_of(mesh, matched)}};
}

int verify_file(const VerifyOptions& options) {
  delaunay::PointMesh mesh = delaunay::read_mesh(options.mesh, options.points.limits.budget());
  if (mesh.triangulation.dim != options.dim && mesh.triangulation.size() > 0) {
    throw UsageError(fmt::format("--dim {}: {} has simplices of dimension {}", options.dim,
                                 options.mesh, mesh.triangulation.dim));
  }
  const Matched matched = match(options, mesh, load_points(options.points, options.dim));
  const auto check_simplices = options.part ? &delaunay::verify_part : &delaunay::verify_simplices;
  const delaunay::Verdict verdict = check_simplices(
      options.dim, delaunay::view(mesh.points.positions), mesh.triangulation.vertices);

  const bool good = (options.canonical ? verdict.canonical : verdict.delaunay) &&
                    !(options.complete && matched.unused > 0) && !matched.other_height;
  const std::string where = verdict.simplex ? fmt::format("simplex {}: ", *verdict.simplex) : "";
  write_statistics(options.statistics,
                   verify_json(options, checked_json(mesh, matched, verdict), verdict));
  if (!verdict.reason.empty()) {
    const char* const rows = matched.by_rows() ? "" : " (rows are those of the mesh's vertices)";
    if (good) {
      spdlog::info("{}{}{}", where, verdict.reason, rows);
    } else {
      spdlog::error("{}: {}{}{}", options.mesh, where, verdict.reason, rows);
    }
  }
  if (matched.other_height) {
    const std::size_t v = *matched.other_height;
    spdlog::error("{}: vertex {}: the height is {}, that of the point {} is {}{}", options.mesh, v,
                  mesh.points.positions[v].z, place_of(mesh.points.positions[v], 2), matched.height,
                  options.points.duplicates.empty()
                      ? " (of points in one place --duplicates says which counts)"
                      : "");
  }
  if (matched.unused > 0) {
    const std::string text =
        fmt::format("{} of {} distinct points of {} are no vertex of {}", matched.unused,
                    matched.distinct, options.points.path, options.mesh);
    if (options.complete) {
      spdlog::error("{}", text);
    } else {
      spdlog::warn("{}, which is checked as the triangulation of its own vertices", text);
    }
  }
  if (options.statistics != "-") {
    fmt::print("valid: {}\ndelaunay: {}\ncanonical: {}\nchecked: {}\n",
               verdict.valid ? "yes" : "no", verdict.delaunay ? "yes" : "no",
               verdict.canonical ? "yes" : "no", what_was_checked(mesh, matched));
  }
  return good ? kDone : kNotVerified;
}

int run(Session& session, const VerifyOptions& options) {
  if (options.mesh.empty()) throw UsageError("verify: MESH is missing");
  if (packs::is_pack(options.mesh)) {
    if (options.part) throw UsageError("--part: not of a pack");
    check_outputs({{"--stats", options.statistics}}, {options.mesh});
    return verify_pack(session, options);
  }
  if (options.points.path.empty()) {
    // Opening it says what is wrong with it.
    if (options.mesh.ends_with(".pack"))
      packs::PackReader(options.mesh, options.points.limits.budget());
    throw UsageError(fmt::format(
        "--points is missing: the points that {} should be the triangulation of (only packs are "
        "checked by themselves)",
        options.mesh));
  }
  std::vector<std::string> inputs = options.points.paths;
  inputs.push_back(options.mesh);
  check_outputs({{"--stats", options.statistics}}, inputs);
  tell_left_out(options.points);
  check(session, options.launch);
  if (options.part && (options.dim > 3 || delaunay::is_mesh_folder(options.mesh))) {
    throw UsageError("--part: of a mesh in one file, in 2D or 3D");
  }
  if (options.dim > 3) return verify_beyond_space(session, options);
  if (delaunay::is_mesh_folder(options.mesh)) return verify_folder(session, options);
  refuse_parts_of_folders(options.mesh);
  if (options.launch.ranks > 1 || session.processes > 1 || !options.scratch.empty()) {
    throw UsageError(fmt::format(
        "{} is one file, which is checked in memory by one rank (--threads shares the work); "
        "several ranks and --scratch are for a folder of pieces, as triangulate -o FOLDER/ writes",
        options.mesh));
  }
  const int threads = threads_per_rank(options.launch, 1);
  const parallel::AllowThreads allowed(threads);
  parallel::Arena arena(threads);
  return arena.execute([&] { return verify_file(options); });
}

}  // namespace

void add_verify(CLI::App& program, Session& session) {
  CLI::App* command = program.add_subcommand(
      "verify", "Check a triangulation against its points, with exact arithmetic, or a pack");
  const auto options = std::make_shared<VerifyOptions>();
  command
      ->add_option(
          "MESH", options->mesh,
          "Triangulation to check, a file or a folder of pieces: the exit code is 0 if it "
          "is what the options demand, 4 if it is "
          "not, 3 if a vertex is none of the points. A pack is checked by itself: 3 if any "
          "of it is damaged")
      ->group(group::kInput);
  add_points_argument(*command, "--points", options->points,
                      "Points that MESH should be the triangulation of: files, folders, patterns");
  command
      ->add_option("--dim", options->dim,
                   "Dimension: 2 (default) or 3, or 4 to 6 of .node and .ele")
      ->check(one_of({"2", "3", "4", "5", "6"}));
  command->add_flag(
      "--canonical", options->canonical,
      "Also demand the choice that delray makes among cocircular or cospherical points");
  command->add_flag(
      "--complete", options->complete,
      "Also demand that every point is a vertex (simplified terrains leave some out)");
  command->add_flag("--part", options->part,
                    "Let simplices be missing, as outside of an outline that triangulate "
                    "--min-angle refined: those there are must be canonical");
  command
      ->add_option("--stats", options->statistics,
                   "Verdict as JSON to this file; - for standard output")
      ->type_name("FILE")
      ->group(group::kOutput);
  add_launch_options(*command, options->launch);
  command
      ->add_option("--scratch", options->scratch,
                   "Folder for borders of pieces that memory does not hold (default: TMPDIR)")
      ->group(group::kParallel)
      ->type_name("DIR");
  add_point_options(*command, options->points);
  add_common_options(*command, session,
                     "verify mesh.ply --points points.las\n"
                     "verify mesh/ --points tiles/*.laz --memory 2GiB\n"
                     "verify mesh.off --points points.csv --canonical --stats -\n"
                     "verify simplified.stl --points terrain.tif\n"
                     "verify scene.pack");
  command->callback([&session, options] {
    // --points takes all names that follow.
    std::vector<std::string>& points = options->points.paths;
    if (options->mesh.empty() && points.size() > 1) {
      options->mesh = points.back();
      points.pop_back();
      options->points.name_paths();
    }
    session.run = [&session, options] { return run(session, *options); };
  });
}

}  // namespace delray::apps
