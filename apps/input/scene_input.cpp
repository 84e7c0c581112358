// Recognizes the kind of an input by its format and sends it to the right reader: scenes and
// generated scenes as they are, points through a triangulation or as dots, meshes of points as
// surfaces. Options that do not go with the kind are refused.
#include "apps/input/scene_input.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "apps/input/colour_by.h"
#include "apps/input/coloured_points.h"
#include "apps/input/geographic.h"
#include "apps/input/point_shape.h"
#include "apps/input/relief.h"
#include "apps/input/show_as.h"
#include "apps/options/help.h"
#include "apps/options/list.h"
#include "apps/options/numbers.h"
#include "delaunay/mesh_folder.h"
#include "delaunay/read_mesh.h"
#include "delaunay/triangulate.h"
#include "files/error.h"
#include "files/format.h"
#include "files/read_file.h"
#include "packs/unpack.h"
#include "parallel/arena.h"
#include "scenes/generate.h"
#include "scenes/load.h"

namespace delray::apps {
namespace {

using files::Format;

// PLY with 64-bit coordinates is what triangulations are written as; scene loaders would round it.
bool has_double_coordinates(const std::string& path) {
  constexpr std::size_t kHeader = 4096;
  const std::string start = files::read_start(path, kHeader);
  return start.find("property double x") != std::string::npos ||
         start.find("property float64 x") != std::string::npos;
}

// Whether an .ele beside this .node makes a mesh of its points.
bool has_elements(const std::string& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(std::filesystem::path(path).replace_extension(".ele"),
                                          error);
}

// Why points have no triangulation over x and y.
std::string no_surface(const delaunay::PointCloud& points) {
  const auto same_height = [&](const glm::dvec3& p) { return p.z == points.positions[0].z; };
  const bool level = std::ranges::all_of(points.positions, same_height);
  return std::string(level ? "all points are equal or on one line"
                           : "all points lie above one point or line of x and y") +
         ": there is no surface of heights to show; --show-as points shows the points";
}

bool has_size(const SceneInput& input) { return input.point_size > 0 || input.radius >= 0; }

[[noreturn]] void fail(const SceneInput& input, const std::string& what) {
  throw files::FileError(files::Cause::input, input.file.path, "", what);
}

scenes::Scene as_points(const SceneInput& input, const delaunay::PointCloud& points,
                        const ShowAs& how) {
  input.file.limits.budget().require(points.size() * kBytesPerShownPoint, input.file.path);
  scenes::Scene scene = coloured(input, points, {});
  show_points(how, size_of(input), scene);
  return scene;
}

bool is_for_surfaces(const SceneInput& input) {
  return !input.file.duplicates.empty() || input.colour_by == "simplex";
}

// The row that --show-as names, or the one that suits the points.
const ShowAs& shown_as(const SceneInput& input, const delaunay::PointCloud& points, bool picture) {
  if (const ShowAs* const asked = asked_to_show(input)) return *asked;
  if (is_for_surfaces(input) || picture || !are_in_space(points)) return show_as().front();
  spdlog::info(
      "{}: the points lie in space, not over a plane: shown as spheres (--show-as relief makes a "
      "surface of them)",
      input.file.path);
  return find_entry(show_as(), "spheres", "--show-as");
}

LoadedScene from_points(const SceneInput& input, parallel::Progress* progress,
                        const ScenePreview& preview) {
  tell_left_out(input.file);
  const bool picture = is_picture(input.file);
  const auto cloud = std::make_shared<delaunay::PointCloud>(read_cloud(input.file));
  delaunay::PointCloud& points = *cloud;
  to_metres(points, input.file.path);
  const ShowAs& how = shown_as(input, points, picture);
  if (points.size() > kPointsOfPreview)
    offer(preview, [&] { return coloured_preview(input, points); });
  if (how.is_points()) return {as_points(input, points, how), cloud};
  merge_places(input.file, points);
  delaunay::Options options;
  options.threads = parallel::arena_threads();
  options.progress = progress;
  require_memory_to_triangulate(input.file, points.size(), options.dim);
  const delaunay::Triangulation triangulation =
      triangulate(delaunay::view(points.positions), options).triangulation;
  if (triangulation.size() == 0) fail(input, no_surface(points));
  return {coloured(input, points, triangulation), cloud};
}

// Bytes that a triangle takes while its mesh becomes a scene, besides the mesh; measured.
std::uint64_t bytes_of_scene(const SceneInput& input, std::uint64_t triangles) {
  constexpr std::uint64_t kBytes = 160, kBytesApart = 230;  // that have vertices of their own
  return triangles * (input.colour_by == "simplex" ? kBytesApart : kBytes);
}

// Asks for all that a folder will take before the first piece is read.
void require_memory_for_folder(const SceneInput& input) {
  const files::MemoryBudget memory = input.file.limits.budget();
  const delaunay::MeshFolder folder(input.file.path, memory);
  folder.check_sizes();  // so that the index can be believed
  const delaunay::MeshIndex& index = folder.index();
  const std::uint64_t corners = index.simplices * (static_cast<std::uint64_t>(index.dim) + 1);
  const std::uint64_t triangles = index.dim == 2 ? index.simplices : index.hull_facets;
  const std::uint64_t mesh = index.distinct * sizeof(glm::dvec3) + corners * sizeof(std::uint32_t);
  memory.require(mesh + bytes_of_scene(input, triangles), input.file.path,
                 fmt::format("a picture of {} simplices in memory", index.simplices));
}

scenes::Scene from_mesh(const SceneInput& input, const ScenePreview& preview) {
  const files::MemoryBudget memory = input.file.limits.budget();
  if (delaunay::is_mesh_folder(input.file.path)) require_memory_for_folder(input);
  delaunay::PointMesh mesh = delaunay::read_mesh(input.file.path, memory);
  if (mesh.triangulation.dim == 2) {
    memory.require(bytes_of_scene(input, mesh.triangulation.size()), input.file.path,
                   fmt::format("scene of {} triangles", mesh.triangulation.size()));
  }
  for (const std::string& warning : mesh.points.warnings) {
    spdlog::warn("{}: {}", input.file.path, warning);
  }
  if (mesh.triangulation.size() == 0) {
    fail(input, "the mesh has points, but no triangles or tetrahedra to show");
  }
  keep_corners(mesh.points, mesh.triangulation);
  to_metres(mesh.points, input.file.path);
  scenes::Scene scene = coloured(input, mesh.points, mesh.triangulation);
  offer_coarse(preview, scene);
  return scene;
}

// As the options want a scene to look.
void set_look(const SceneInput& input, scenes::Scene& scene) {
  if (has_size(input) && !set_point_size(size_of(input), scene)) {
    throw UsageError(fmt::format("--point-size and --radius are for points and lines; {} has none",
                                 input.file.path));
  }
  set_up_axis(input, scene);
  if (!input.colour_by.empty()) colour_by(scene, input.colour_by, nullptr);
}

scenes::Scene loaded(const SceneInput& input, parallel::Progress* progress,
                     const ScenePreview& preview) {
  const auto offer_some = [&](const scenes::Scene& whole) {
    offer_coarse(preview, whole, [&](scenes::Scene& some) { set_look(input, some); });
  };
  scenes::Scene scene;
  if (scenes::is_generated(input.file.path)) {
    try {
      input.file.limits.budget().require(scenes::generated_bytes(input.file.path), input.file.path);
      scene = scenes::generate(input.file.path);
      offer_some(scene);
    } catch (const std::invalid_argument& error) {
      throw UsageError(error.what());
    }
  } else {
    std::vector<std::string> warnings;
    const InputLimits& limits = input.file.limits;
    scene = scenes::load(input.file.path, warnings,
                         {.memory = limits.budget(),
                          .outside = limits.outside(),
                          .progress = progress,
                          .on_read = offer_some});
    for (const std::string& warning : warnings) spdlog::warn(warning);
  }
  set_look(input, scene);
  return scene;
}

scenes::Scene unpacked(const SceneInput& input) {
  refuse_for_packs(input);
  const files::MemoryBudget memory = input.file.limits.budget();
  packs::PackReader pack(input.file.path, memory);
  scenes::Scene scene = packs::unpack(pack, memory);
  set_up_axis(input, scene);
  return scene;
}

}  // namespace

InputKind input_kind(const std::string& path, const files::MemoryBudget& memory) {
  if (scenes::is_generated(path)) return InputKind::scene;
  if (delaunay::is_mesh_folder(path)) return InputKind::mesh;
  const files::FileKind kind = files::identify(path, memory);
  switch (kind.format) {
    case Format::vtu:
      return InputKind::mesh;
    case Format::node:
      return path.ends_with(".ele") || has_elements(path) ? InputKind::mesh : InputKind::points;
    case Format::ply:
      if (!kind.has_faces) return InputKind::points;
      return has_double_coordinates(path) ? InputKind::mesh : InputKind::scene;
    case Format::obj:
    case Format::off:
      if (!kind.has_faces) return InputKind::points;
      return kind.by_delray ? InputKind::mesh : InputKind::scene;
    case Format::stl:
      return kind.by_delray ? InputKind::mesh : InputKind::scene;
    case Format::gltf:
    case Format::glb:
    case Format::unknown:  // the scene loader says what it can read
      return InputKind::scene;
    case Format::image:
      return InputKind::picture;
    case Format::pack:
      return InputKind::pack;
    default:
      return InputKind::points;
  }
}

void add_scene_options(CLI::App& command, SceneInput& input) {
  add_points_argument(
      command, "SCENE", input.file,
      "Scene, mesh or points (delray info --list names the formats; of points several files, "
      "folders or patterns), elevation picture, or generated scene gen:KIND[:TRIANGLES[:SEED]], "
      "such as gen:city:1e6");
  command
      .add_option(
          "--color-by,--colour-by", input.colour_by,
          "What colours show: material, z (height) or simplex (a colour for each triangle); of "
          "points also rgb, intensity, classification or returns (default: what the file has)")
      ->group(group::kInput);
  command
      .add_option("--exaggeration", input.exaggeration,
                  "Factor that stretches the heights of points (default: 1)")
      ->group(group::kInput)
      ->check(positive_number());
  command
      .add_option("--show-as", input.show_as,
                  "Show points as a relief, the surface of heights over x and y, or as points, "
                  "discs or spheres (default: spheres for scans, where many lie above each other; "
                  "points with --point-size or --radius; else relief)")
      ->group(group::kInput);
  choose_from(command, "--show-as", names_in(show_as()));
  // The name of versions before, without a place in the help.
  command
      .add_option_function<std::string>(
          "--draw",
          [&input](const std::string& what) {
            input.show_as = what == "points" ? "spheres" : "relief";
          },
          "Older name of --show-as: surface for relief, or points for "
          "spheres")
      ->group("")
      ->check(one_of({"surface", "points"}))
      ->excludes("--show-as");
  command
      .add_option("--point-size", input.point_size,
                  "Diameter of points in pixels, for --show-as points, discs or spheres (default: "
                  "neighbours touch)")
      ->group(group::kInput)
      ->check(number_between(1e-3, 10000));
  command
      .add_option("--radius", input.radius,
                  "Radius of points in units of the scene, for --show-as points, discs or spheres "
                  "(default: neighbours touch)")
      ->group(group::kInput)
      ->check(number_between(0, 1e18))
      ->excludes("--point-size");
  command
      .add_option("--up", input.up,
                  "Axis that points up: y or z (default: as the file says; else z for points and "
                  "meshes of them and STL, y for others unless they stand on a flat base of z)")
      ->group(group::kInput)
      ->check(one_of({"y", "z"}));
  choose_from(command, "--color-by", names_in(colour_bys()));
  add_point_options(command, input.file);
  add_outside_option(command, input.file.limits);
}

InputKind input_kind_of(const PointInput& input) {
  const files::MemoryBudget memory = input.limits.budget();
  if (!input.is_set()) return input_kind(input.path, memory);
  for (const std::string& path : input.paths) {
    std::error_code error;
    if (!scenes::is_generated(path) && !std::filesystem::is_regular_file(path, error)) continue;
    const InputKind kind = input_kind(path, memory);
    if (kind == InputKind::scene || kind == InputKind::mesh || kind == InputKind::pack) {
      throw UsageError(
          fmt::format("{} is a scene or mesh: only points are read from several files", path));
    }
  }
  return InputKind::points;
}

InputKind input_kind_of(const SceneInput& input) {
  // Options of points ask for those of a .node, without the .ele beside it.
  const bool is_node = files::format_of_suffix(input.file.path) == Format::node &&
                       !input.file.path.ends_with(".ele");
  const InputKind kind = input_kind_of(input.file);
  return is_node && (input.file.given() || !input.show_as.empty() || has_size(input))
             ? InputKind::points
             : kind;
}

const ShowAs* asked_to_show(const SceneInput& input) {
  if (input.show_as.empty())
    return has_size(input) ? &find_entry(show_as(), "points", "--show-as") : nullptr;
  const ShowAs& how = find_entry(show_as(), input.show_as, "--show-as");
  if (how.is_points() && is_for_surfaces(input)) {
    throw UsageError(fmt::format(
        "--duplicates and --color-by simplex are for surfaces, not --show-as {}", how.name));
  }
  return &how;
}

// Dots have no triangles that could be told apart.
std::string colouring(const SceneInput& input, const delaunay::PointCloud& points, bool dots) {
  if (!input.colour_by.empty()) return input.colour_by;
  const std::string_view suits = default_colour_by(points);
  return std::string(dots && suits == "simplex" ? "z" : suits);
}

PointSize size_of(const SceneInput& input) {
  return {static_cast<float>(input.point_size), static_cast<float>(input.radius)};
}

void check_reach(const SceneInput& input, std::span<const glm::dvec3> points,
                 const glm::dvec3& middle) {
  constexpr double kFarthest = 1e18;  // as of scenes
  for (const glm::dvec3& p : points) {
    const glm::dvec3 offset = glm::abs(p - middle) * glm::dvec3(1, 1, input.exaggeration);
    if (std::max({offset.x, offset.y, offset.z}) <= kFarthest) continue;
    throw files::FileError(
        files::Cause::input, input.file.path, "",
        "a point is more than 1e18 from the others: there is no picture of that");
  }
}

void warn_of_outliers(const SceneInput& input, const Inliers& inliers, std::uint64_t points) {
  if (inliers.outside == 0) return;
  spdlog::warn("{}: {} of {} points lie far off all others: the view is of the others",
               input.file.path, inliers.outside, points);
}

void refuse_options_of_points(const SceneInput& input, InputKind kind) {
  if (input.file.given()) {
    throw UsageError(fmt::format(
        "--terrain-rgb, --cell-size, --duplicates and options that choose points are for "
        "points; {} is a scene",
        input.file.path));
  }
  if (!input.show_as.empty()) {
    throw UsageError(fmt::format("--show-as is for points; {} is a scene", input.file.path));
  }
  if (kind == InputKind::mesh && has_size(input)) {
    throw UsageError(
        fmt::format("--point-size and --radius are for points; {} is a mesh", input.file.path));
  }
}

bool is_plain(const SceneInput& input) {
  return !input.file.given() && input.show_as.empty() && !has_size(input) &&
         input.colour_by.empty() && input.exaggeration == 1;
}

void refuse_for_packs(const SceneInput& input) {
  if (is_plain(input)) return;
  throw UsageError(fmt::format(
      "options of points, --show-as, --color-by and --exaggeration are for delray pack; {} "
      "is packed already",
      input.file.path));
}

scenes::Scene load_scene(const SceneInput& input, parallel::Progress* progress) {
  return load_scene_and_points(input, progress, {}).scene;
}

LoadedScene load_scene_and_points(const SceneInput& input, parallel::Progress* progress,
                                  const ScenePreview& preview) {
  const InputKind kind = input_kind_of(input);
  if (kind != InputKind::scene || scenes::is_generated(input.file.path)) {
    refuse_outside(input.file.path, input.file.limits);
  }
  if (input.show_as == "relief" && has_size(input))
    throw UsageError("--point-size and --radius have no effect with --show-as relief");
  if (kind == InputKind::points || kind == InputKind::picture) {
    return from_points(input, progress, preview);
  }
  if (kind == InputKind::pack) return {unpacked(input), nullptr};
  refuse_options_of_points(input, kind);
  if (kind == InputKind::mesh) return {from_mesh(input, preview), nullptr};
  if (input.exaggeration != 1) {
    throw UsageError(fmt::format("--exaggeration is for points; {} is a scene", input.file.path));
  }
  return {loaded(input, progress, preview), nullptr};
}

}  // namespace delray::apps
