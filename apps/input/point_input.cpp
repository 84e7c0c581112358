// Reads files of points and pictures of elevations as one input. Also the options of point inputs
// and their checks.
#include "apps/input/point_input.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "apps/input/point_parts_input.h"
#include "apps/options/help.h"
#include "apps/options/list.h"
#include "apps/options/numbers.h"
#include "delaunay/duplicates.h"
#include "delaunay/mesh_folder.h"
#include "delaunay/open_points.h"
#include "delaunay/read_points.h"
#include "files/error.h"
#include "files/format.h"
#include "files/read_file.h"

namespace delray::apps {

std::vector<std::filesystem::path> named_files(const PointInput& input) {
  if (input.paths.empty()) return {input.path};
  return {input.paths.begin(), input.paths.end()};
}

void tell_left_out(const PointInput& input) {
  for (const std::filesystem::path& path : delaunay::left_out_of_folders(named_files(input))) {
    spdlog::warn("{}: left out, as it does not begin with points (name the file to see why)",
                 path.string());
  }
}

bool is_picture_file(const std::filesystem::path& path, const files::MemoryBudget& memory) {
  // Of thousands of tiles four bytes each will do.
  constexpr std::string_view kLas = "LASF";
  if (files::read_start(path, kLas.size(), memory) == kLas) return false;
  return files::identify_format(path, memory) == files::Format::image;
}

void PointInput::name_paths() {
  path = paths.size() == 1 ? paths[0] : fmt::format("{} and {} more", paths[0], paths.size() - 1);
}

bool PointInput::is_set() const {
  if (paths.size() <= 1 && delaunay::is_mesh_folder(path)) return false;
  if (paths.size() > 1) return true;
  if (path == "-" || path.empty()) return false;
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return true;
  return path.find_first_of("*?") != std::string::npos && !std::filesystem::exists(path, error);
}

CLI::Option* add_points_argument(CLI::App& command, const std::string& name, PointInput& input,
                                 const std::string& description) {
  return command
      .add_option_function<std::vector<std::string>>(
          name,
          [&input](const std::vector<std::string>& paths) {
            input.paths = paths;
            input.name_paths();
          },
          description)
      ->type_name("FILE")
      ->group(group::kInput);
}

bool is_picture(const PointInput& input) {
  return !input.is_set() && is_picture_file(input.path, input.limits.budget());
}

void add_point_options(CLI::App& command, PointInput& input) {
  command
      .add_flag("--terrain-rgb", input.terrain_rgb,
                "Decode heights from the colours of an elevation picture (Mapbox terrain-RGB)")
      ->group(group::kInput);
  command
      .add_option("--cell-size", input.cell_size,
                  "Distance between the pixels of an elevation picture, in units of its heights "
                  "(default: from the GeoTIFF, else such that the relief shows)")
      ->group(group::kInput)
      ->check(positive_number());
  command
      .add_option("--duplicates", input.duplicates,
                  "Height to take where several points have the same x and y: first (default), "
                  "min, max or mean")
      ->group(group::kInput);
  choose_from(command, "--duplicates", names_in(delaunay::duplicates_policies()));
  add_choice_options(command, input.choice);
  add_memory_option(command, input.limits);
}

delaunay::PointSummary summarize(const PointInput& input) {
  return delaunay::summarize_points(named_files(input), filter_of(input.choice),
                                    {.memory = input.limits.budget()});
}

delaunay::PointCloud read_cloud(const PointInput& input) {
  const InputFiles files = find_input_files(input);
  const delaunay::ReadOptions options = {.memory = input.limits.budget()};
  delaunay::PointCloud cloud;
  if (!files.any_picture) {
    cloud = delaunay::read_points(files.paths, filter_of(input.choice), options);
  } else if (const auto parts = open_parts(input); parts->parts() > 1) {
    cloud = delaunay::read_points(*parts, options);
  } else {
    parts->read(0, cloud);
    if (cloud.size() == 0) {
      throw files::FileError(files::Cause::input, input.path, "", "no pixel is within --bounds");
    }
  }
  for (const std::string& warning : cloud.warnings) spdlog::warn("{}: {}", input.path, warning);
  return cloud;
}

void merge_places(const PointInput& input, delaunay::PointCloud& cloud) {
  const std::string_view duplicates = input.duplicates.empty() ? "first" : input.duplicates.c_str();
  const auto& policy =
      find_entry(delaunay::duplicates_policies(), duplicates, "--duplicates").policy;
  const delaunay::DuplicatesCount merged = merge_duplicates(cloud, policy);
  if (merged.places > 0) {
    spdlog::warn("{}: {} places have several heights ({} rows): took the {}", input.path,
                 merged.places, merged.rows, duplicates);
  }
}

delaunay::PointCloud load_points(const PointInput& input, int dim) {
  if (dim == 3 && !input.duplicates.empty()) {
    throw UsageError("--duplicates: points of 3D are equal only if their z is");
  }
  delaunay::PointCloud cloud = read_cloud(input);
  if (dim == 2) {
    merge_places(input, cloud);
  } else if (!cloud.has_z) {
    refuse_without_z(input);
  }
  return cloud;
}

void refuse_without_z(const PointInput& input) {
  throw UsageError("--dim 3: " + input.path + " has no z");
}

files::CoordinateSystem coordinate_system_of(const PointInput& input) {
  if (files::is_stream(input.path)) return {};
  if (!is_picture(input)) return files::read_las_coordinate_system(input.path);
  files::CoordinateSystem system;
  system.raster = input.path;
  return system;
}

void require_memory_to_triangulate(const PointInput& input, std::size_t points, int dim) {
  input.limits.budget().require(points * (dim == 2 ? kBytesToTriangulate2D : kBytesToTriangulate3D),
                                input.path,
                                "triangulation of " + std::to_string(points) + " points");
}

}  // namespace delray::apps
