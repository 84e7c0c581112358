// Opens files of points and pictures of elevations as one input, in parts or whole. Also the
// options of point inputs and their checks.
#include "apps/input/point_input.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <span>

#include "apps/input/elevations.h"
#include "apps/options/help.h"
#include "apps/options/list.h"
#include "apps/options/numbers.h"
#include "delaunay/duplicates.h"
#include "delaunay/open_points.h"
#include "delaunay/read_points.h"
#include "files/error.h"
#include "files/format.h"
#include "files/read_file.h"
#include "image/io.h"

namespace delray::apps {
namespace {

std::vector<std::filesystem::path> named_files(const PointInput& input) {
  if (input.paths.empty()) return {input.path};
  return {input.paths.begin(), input.paths.end()};
}

bool is_picture_file(const std::filesystem::path& path, const files::MemoryBudget& memory) {
  // Of thousands of tiles four bytes each will do.
  constexpr std::string_view kLas = "LASF";
  if (files::read_start(path, kLas.size(), memory) == kLas) return false;
  return files::identify_format(path, memory) == files::Format::image;
}

void drop_outside(const delaunay::PointFilter& filter, delaunay::PointCloud& points) {
  if (!filter.bounds) return;
  const geometry::Box3d& box = *filter.bounds;
  std::erase_if(points.positions, [&](const glm::dvec3& p) {
    return glm::any(glm::lessThan(p, box.low)) || glm::any(glm::greaterThan(p, box.high));
  });
}

// All of a picture is one part.
class ElevationParts : public delaunay::PointParts {
 public:
  ElevationParts(std::filesystem::path path, const ElevationOptions& options,
                 const delaunay::PointFilter& filter, const files::MemoryBudget& memory)
      : path_(std::move(path)), options_(options), filter_(filter), memory_(memory) {
    const image::PictureInfo info = image::read_info(path_, memory_);
    pixels_ = static_cast<std::uint64_t>(info.width) * static_cast<std::uint64_t>(info.height);
  }
  std::size_t parts() const override { return 1; }
  std::uint64_t most_rows(std::size_t) const override { return pixels_; }
  void read(std::size_t, delaunay::PointCloud& points) const override {
    points = read_elevations(path_, options_, memory_);
    drop_outside(filter_, points);
  }

 private:
  std::filesystem::path path_;
  ElevationOptions options_;
  delaunay::PointFilter filter_;
  files::MemoryBudget memory_;
  std::uint64_t pixels_ = 0;
};

// The files that an input stands for, in order, and which are pictures.
struct InputFiles {
  std::vector<std::filesystem::path> paths;
  std::vector<bool> pictures;
  bool any_picture = false;
};

// Throws UsageError where options have no effect on the files.
InputFiles find_files(const PointInput& input) {
  InputFiles files;
  files.paths = delaunay::expand_inputs(named_files(input));
  for (const std::filesystem::path& path : files.paths) {
    files.pictures.push_back(is_picture_file(path, input.limits.budget()));
    files.any_picture = files.any_picture || files.pictures.back();
  }
  if (!files.any_picture && (input.terrain_rgb || input.cell_size > 0)) {
    throw UsageError("--terrain-rgb and --cell-size are for elevation pictures");
  }
  const PointChoice& choice = input.choice;
  if (files.any_picture &&
      (!choice.classes.empty() || !choice.returns.empty() || choice.resolution > 0)) {
    throw UsageError("--class, --returns and --resolution are not for elevation pictures");
  }
  return files;
}

std::unique_ptr<delaunay::PointParts> open_files(const PointInput& input, const InputFiles& files) {
  const delaunay::PointFilter filter = filter_of(input.choice);
  const files::MemoryBudget memory = input.limits.budget();
  if (!files.any_picture) return delaunay::open_points(files.paths, filter, {.memory = memory});
  std::vector<std::unique_ptr<delaunay::PointParts>> parts;
  for (std::size_t i = 0; i < files.paths.size(); ++i) {
    if (files.pictures[i]) {
      parts.push_back(std::make_unique<ElevationParts>(
          files.paths[i], ElevationOptions{input.terrain_rgb, input.cell_size}, filter, memory));
    } else {
      parts.push_back(
          delaunay::open_points(std::span(&files.paths[i], 1), filter, {.memory = memory}));
    }
  }
  return delaunay::join_parts(std::move(parts));
}

delaunay::PointCloud read_with_pictures(const PointInput& input, const InputFiles& files) {
  const files::MemoryBudget memory = input.limits.budget();
  if (files.paths.size() > 1) {
    return delaunay::read_points(*open_files(input, files), {.memory = memory});
  }
  delaunay::PointCloud points =
      read_elevations(files.paths[0], {input.terrain_rgb, input.cell_size}, memory);
  drop_outside(filter_of(input.choice), points);
  if (points.size() > 0) return points;
  throw files::FileError(files::Cause::input, input.path, "", "no pixel is within --bounds");
}

}  // namespace

void PointInput::name_paths() {
  path = paths.size() == 1 ? paths[0] : fmt::format("{} and {} more", paths[0], paths.size() - 1);
}

bool PointInput::is_set() const {
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

std::filesystem::path first_file(const PointInput& input) {
  return delaunay::expand_inputs(named_files(input)).front();
}

std::unique_ptr<delaunay::PointParts> open_parts(const PointInput& input) {
  return open_files(input, find_files(input));
}

delaunay::PointSummary summarize(const PointInput& input) {
  return delaunay::summarize_points(named_files(input), filter_of(input.choice),
                                    {.memory = input.limits.budget()});
}

delaunay::PointCloud read_cloud(const PointInput& input) {
  const InputFiles files = find_files(input);
  const delaunay::ReadOptions options = {.memory = input.limits.budget()};
  delaunay::PointCloud cloud =
      files.any_picture ? read_with_pictures(input, files)
                        : delaunay::read_points(files.paths, filter_of(input.choice), options);
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
    throw UsageError("--dim 3: " + input.path + " has no z");
  }
  return cloud;
}

void require_memory_to_triangulate(const PointInput& input, std::size_t points, int dim) {
  // Measured of the default methods on uniform points, besides the points themselves.
  constexpr std::uint64_t kBytes2D = 70, kBytes3D = 260;
  input.limits.budget().require(points * (dim == 2 ? kBytes2D : kBytes3D), input.path,
                                "triangulation of " + std::to_string(points) + " points");
}

}  // namespace delray::apps
