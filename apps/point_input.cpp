#include "apps/point_input.h"

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "apps/list.h"
#include "apps/numbers.h"
#include "delaunay/duplicates.h"
#include "delaunay/read_points.h"
#include "files/error.h"
#include "files/format.h"
#include "image/io.h"

namespace delray::apps {
namespace {

// The height that a pixel's values stand for.
double height_of(const double* values, std::size_t channels, bool terrain_rgb) {
  if (!terrain_rgb || channels < 3) return values[0];
  return -10000.0 + (values[0] * 65536.0 + values[1] * 256.0 + values[2]) / 10.0;
}

// Elevations say nothing about the distance of their pixels: without --cell-size the relief is as
// high as a fifth of its longer side.
double guessed_cell_size(const delaunay::PointCloud& cloud, int longer_side) {
  const auto [low, high] =
      std::minmax_element(cloud.positions.begin(), cloud.positions.end(),
                          [](const glm::dvec3& a, const glm::dvec3& b) { return a.z < b.z; });
  const double relief = high->z - low->z;
  return relief > 0 ? 5.0 * relief / longer_side : 1.0;
}

}  // namespace

void add_point_options(CLI::App& command, PointInput& input) {
  command.add_flag("--terrain-rgb", input.terrain_rgb,
                   "a picture's colours are Mapbox terrain-RGB heights");
  command
      .add_option("--cell-size", input.cell_size,
                  "distance of the pixels of an elevation picture, in units of its heights")
      ->check(positive_number());
  command.add_option("--duplicates", input.duplicates,
                     "height of places that have several: first (default), min, max, mean");
  add_memory_option(command, input.limits);
}

delaunay::PointCloud read_elevations(const PointInput& input) {
  const image::RawChannels picture = image::read_float_channels(input.path, input.limits.budget());
  if (input.terrain_rgb && picture.channels.size() < 3) {
    throw files::FileError(files::Cause::input, input.path, "",
                           "terrain-RGB needs three channels, this picture has " +
                               std::to_string(picture.channels.size()));
  }
  delaunay::PointCloud cloud;
  cloud.has_z = true;
  input.limits.budget().require(
      picture.values.size() / picture.channels.size() * sizeof(glm::dvec3), input.path);
  cloud.positions.reserve(picture.values.size() / picture.channels.size());
  const double* values = picture.values.data();
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x, values += picture.channels.size()) {
      const double height = height_of(values, picture.channels.size(), input.terrain_rgb);
      if (std::isfinite(height)) cloud.positions.emplace_back(x, -y, height);
    }
  }
  if (cloud.positions.empty()) {
    throw files::FileError(files::Cause::input, input.path, "", "no pixel has a finite height");
  }
  const double cell = input.cell_size > 0
                          ? input.cell_size
                          : guessed_cell_size(cloud, std::max(picture.width, picture.height));
  for (glm::dvec3& p : cloud.positions) p = {p.x * cell, p.y * cell, p.z};
  return cloud;
}

delaunay::PointCloud load_points(const PointInput& input, int dim) {
  const std::string_view duplicates = input.duplicates.empty() ? "first" : input.duplicates.c_str();
  const auto& policy =
      find_entry(delaunay::duplicates_policies(), duplicates, "--duplicates").policy;
  const files::MemoryBudget memory = input.limits.budget();
  const bool picture = files::identify_format(input.path, memory) == files::Format::image;
  if (!picture && (input.terrain_rgb || input.cell_size > 0)) {
    throw UsageError("--terrain-rgb and --cell-size are for elevation pictures");
  }
  delaunay::PointCloud cloud =
      picture ? read_elevations(input) : delaunay::read_points(input.path, {.memory = memory});
  if (dim == 2) {
    const delaunay::DuplicatesCount merged = merge_duplicates(cloud, policy);
    if (merged.places > 0) {
      spdlog::warn("{}: {} places have several heights ({} rows): took the {}", input.path,
                   merged.places, merged.rows, duplicates);
    }
  } else if (!input.duplicates.empty()) {
    throw UsageError("--duplicates: points of 3D are equal only if their z is");
  } else if (!cloud.has_z) {
    throw UsageError("--dim 3: " + input.path + " has no z");
  }
  return cloud;
}

}  // namespace delray::apps
