// Reads a point file, or makes a point of every pixel of an elevation picture that has a height.
// Also the options of point inputs and their checks.
#include "apps/input/point_input.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <optional>

#include "apps/input/inliers.h"
#include "apps/options/help.h"
#include "apps/options/list.h"
#include "apps/options/numbers.h"
#include "delaunay/duplicates.h"
#include "delaunay/read_points.h"
#include "files/error.h"
#include "files/format.h"
#include "image/geotiff.h"
#include "image/io.h"

namespace delray::apps {
namespace {

constexpr std::size_t kColourChannels = 3;

// A picture of one channel, or with --terrain-rgb of three, and perhaps an alpha channel.
void check_channels(const PointInput& input, const image::RawChannels& picture) {
  const std::size_t wanted = input.terrain_rgb ? kColourChannels : 1;
  const std::size_t channels = picture.channels.size();
  const bool fits =
      channels == wanted || (channels == wanted + 1 && picture.channels.back() == "A");
  if (fits) return;
  throw files::FileError(
      files::Cause::input, input.path, "",
      input.terrain_rgb
          ? fmt::format("terrain-RGB needs three channels, this picture has {}", channels)
          : fmt::format("heights are a single channel, this picture has {} ({}); --terrain-rgb "
                        "decodes heights from colours",
                        channels, fmt::join(picture.channels, ", ")));
}

// The height that a pixel's values stand for.
double height_of(const double* values, bool terrain_rgb) {
  if (!terrain_rgb) return values[0];
  return -10000.0 + (values[0] * 65536.0 + values[1] * 256.0 + values[2]) / 10.0;
}

// GDAL writes the nearest decimal of a 32-bit float as text.
bool is_missing(double value, std::optional<double> no_data) {
  return no_data && (value == *no_data || value == double{static_cast<float>(*no_data)});
}

// Elevations say nothing about the distance of their pixels: without --cell-size the relief is as
// high as a fifth of its longer side.
double guessed_cell_size(const delaunay::PointCloud& cloud, int longer_side) {
  const geometry::Box3d box = usual_box(cloud);
  const double relief = box.high.z - box.low.z;
  return relief > 0 ? 5.0 * relief / longer_side : 1.0;
}

}  // namespace

bool is_picture(const PointInput& input) {
  return files::identify_format(input.path, input.limits.budget()) == files::Format::image;
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
  add_memory_option(command, input.limits);
}

delaunay::PointCloud read_elevations(const PointInput& input) {
  const files::MemoryBudget memory = input.limits.budget();
  const image::GeoTiff ground = image::read_geotiff(input.path, memory);
  const image::RawChannels picture = image::read_float_channels(input.path, memory);
  check_channels(input, picture);
  const std::size_t channels = picture.channels.size();
  const bool has_alpha = channels != (input.terrain_rgb ? kColourChannels : 1);
  delaunay::PointCloud cloud;
  cloud.has_z = true;
  memory.require(picture.values.size() / channels * sizeof(glm::dvec3), input.path);
  cloud.positions.reserve(picture.values.size() / channels);
  const double* values = picture.values.data();
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x, values += channels) {
      const double height = height_of(values, input.terrain_rgb);
      const bool missing =
          is_missing(values[0], ground.no_data) || (has_alpha && values[channels - 1] == 0);
      if (std::isfinite(height) && !missing) cloud.positions.emplace_back(x, y, height);
    }
  }
  if (cloud.positions.empty()) {
    throw files::FileError(files::Cause::input, input.path, "", "no pixel has a finite height");
  }
  glm::dmat3x2 to_ground;
  if (input.cell_size == 0 && ground.to_ground) {
    to_ground = *ground.to_ground;
    cloud.geographic = ground.geographic;
  } else {
    const double cell = input.cell_size > 0
                            ? input.cell_size
                            : guessed_cell_size(cloud, std::max(picture.width, picture.height));
    to_ground = {cell, 0, 0, -cell, 0, 0};
  }
  for (glm::dvec3& p : cloud.positions) {
    p = glm::dvec3(to_ground * glm::dvec3(p.x, p.y, 1.0), p.z);
  }
  return cloud;
}

delaunay::PointCloud read_cloud(const PointInput& input) {
  const bool picture = is_picture(input);
  if (!picture && (input.terrain_rgb || input.cell_size > 0)) {
    throw UsageError("--terrain-rgb and --cell-size are for elevation pictures");
  }
  delaunay::PointCloud cloud =
      picture ? read_elevations(input)
              : delaunay::read_points(input.path, {.memory = input.limits.budget()});
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
