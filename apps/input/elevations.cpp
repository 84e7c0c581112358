// Makes a point of every pixel of an elevation picture that has a height.
#include "apps/input/elevations.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "apps/input/inliers.h"
#include "files/error.h"
#include "image/geotiff.h"
#include "image/io.h"

namespace delray::apps {
namespace {

constexpr std::size_t kColourChannels = 3;

// A picture of one channel, or with --terrain-rgb of three, and perhaps an alpha channel.
void check_channels(const std::filesystem::path& path, bool terrain_rgb,
                    const image::RawChannels& picture) {
  const std::size_t wanted = terrain_rgb ? kColourChannels : 1;
  const std::size_t channels = picture.channels.size();
  const bool fits =
      channels == wanted || (channels == wanted + 1 && picture.channels.back() == "A");
  if (fits) return;
  throw files::FileError(
      files::Cause::input, path.string(), "",
      terrain_rgb
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

delaunay::PointCloud read_elevations(const std::filesystem::path& path,
                                     const ElevationOptions& options,
                                     const files::MemoryBudget& memory) {
  const image::GeoTiff ground = image::read_geotiff(path, memory);
  const image::RawChannels picture = image::read_float_channels(path, memory);
  check_channels(path, options.terrain_rgb, picture);
  const std::size_t channels = picture.channels.size();
  const bool has_alpha = channels != (options.terrain_rgb ? kColourChannels : 1);
  delaunay::PointCloud cloud;
  cloud.has_z = true;
  memory.require(picture.values.size() / channels * sizeof(glm::dvec3), path.string());
  cloud.positions.reserve(picture.values.size() / channels);
  const double* values = picture.values.data();
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x, values += channels) {
      const double height = height_of(values, options.terrain_rgb);
      const bool missing =
          is_missing(values[0], ground.no_data) || (has_alpha && values[channels - 1] == 0);
      if (std::isfinite(height) && !missing) cloud.positions.emplace_back(x, y, height);
    }
  }
  if (cloud.positions.empty()) {
    throw files::FileError(files::Cause::input, path.string(), "", "no pixel has a finite height");
  }
  glm::dmat3x2 to_ground;
  if (options.cell_size == 0 && ground.to_ground) {
    to_ground = *ground.to_ground;
    cloud.geographic = ground.geographic;
  } else {
    const double cell = options.cell_size > 0
                            ? options.cell_size
                            : guessed_cell_size(cloud, std::max(picture.width, picture.height));
    to_ground = {cell, 0, 0, -cell, 0, 0};
  }
  for (glm::dvec3& p : cloud.positions) {
    p = glm::dvec3(to_ground * glm::dvec3(p.x, p.y, 1.0), p.z);
  }
  return cloud;
}

}  // namespace delray::apps
