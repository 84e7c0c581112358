#include "apps/scene_input.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>

#include "apps/colour_by.h"
#include "apps/list.h"
#include "apps/numbers.h"
#include "apps/relief.h"
#include "delaunay/read_mesh.h"
#include "delaunay/triangulate.h"
#include "files/error.h"
#include "files/format.h"
#include "files/read_file.h"
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

scenes::Scene from_points(const SceneInput& input, const delaunay::PointCloud& points,
                          const delaunay::Triangulation& triangulation) {
  if (triangulation.size() == 0) {
    throw files::FileError(files::Cause::input, input.file.path, "",
                           "all points are equal or on one line: there is no surface to show");
  }
  scenes::Scene scene = relief(points, triangulation, input.exaggeration);
  colour_by(scene, input.colour_by.empty() ? default_colour_by(points) : input.colour_by, &points);
  return scene;
}

scenes::Scene triangulated(const SceneInput& input, parallel::Progress* progress) {
  const delaunay::PointCloud points = load_points(input.file, 2);
  delaunay::Options how;
  how.threads = parallel::arena_threads();
  how.progress = progress;
  return from_points(input, points, triangulate(delaunay::view(points.positions), how));
}

scenes::Scene loaded(const SceneInput& input, parallel::Progress* progress) {
  scenes::Scene scene;
  if (scenes::is_generated(input.file.path)) {
    try {
      scene = scenes::generate(input.file.path);
    } catch (const std::invalid_argument& error) {
      throw UsageError(error.what());
    }
  } else {
    std::vector<std::string> warnings;
    const InputLimits& limits = input.file.limits;
    scene = scenes::load(
        input.file.path, warnings,
        {.memory = limits.budget(), .outside = limits.outside(), .progress = progress});
    for (const std::string& warning : warnings) spdlog::warn(warning);
  }
  if (!input.colour_by.empty()) colour_by(scene, input.colour_by, nullptr);
  return scene;
}

}  // namespace

InputKind input_kind(const std::string& path, const files::MemoryBudget& memory) {
  if (scenes::is_generated(path)) return InputKind::scene;
  const files::FileKind kind = files::identify(path, memory);
  switch (kind.format) {
    case Format::vtu:
      return InputKind::mesh;
    case Format::node:
      return path.ends_with(".ele") ? InputKind::mesh : InputKind::points;
    case Format::ply:
      if (!kind.has_faces) return InputKind::points;
      return has_double_coordinates(path) ? InputKind::mesh : InputKind::scene;
    case Format::obj:
    case Format::off:
      return kind.has_faces ? InputKind::scene : InputKind::points;
    case Format::stl:
    case Format::gltf:
    case Format::glb:
    case Format::unknown:  // the scene loader says what it can read
      return InputKind::scene;
    case Format::image:
      return InputKind::picture;
    default:
      return InputKind::points;
  }
}

void add_scene_options(CLI::App& command, SceneInput& input) {
  command.add_option(
      "SCENE", input.file.path,
      "a scene, mesh or point file, an elevation picture, or gen:KIND[:TRIANGLES[:SEED]]");
  command.add_option("--color-by", input.colour_by,
                     "material, z, simplex; of points also rgb, intensity, classification");
  command
      .add_option("--exaggeration", input.exaggeration,
                  "stretches the heights of points (default 1)")
      ->check(positive_number());
  add_point_options(command, input.file);
  add_outside_option(command, input.file.limits);
}

scenes::Scene load_scene(const SceneInput& input, parallel::Progress* progress) {
  if (!input.colour_by.empty()) find_entry(colour_bys(), input.colour_by, "--color-by");
  const InputKind kind = input_kind(input.file.path, input.file.limits.budget());
  if (kind != InputKind::scene || scenes::is_generated(input.file.path)) {
    refuse_outside(input.file.path, input.file.limits);
  }
  if (kind == InputKind::points || kind == InputKind::picture) {
    return triangulated(input, progress);
  }
  if (input.file.given()) {
    throw UsageError(
        fmt::format("--terrain-rgb, --cell-size and --duplicates are for points; {} is a scene",
                    input.file.path));
  }
  if (kind == InputKind::mesh) {
    const delaunay::PointMesh mesh =
        delaunay::read_mesh(input.file.path, input.file.limits.budget());
    return from_points(input, mesh.points, mesh.triangulation);
  }
  if (input.exaggeration != 1) {
    throw UsageError(fmt::format("--exaggeration is for points; {} is a scene", input.file.path));
  }
  return loaded(input, progress);
}

}  // namespace delray::apps
