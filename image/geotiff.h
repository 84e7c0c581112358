// Georeferencing of TIFF files: the places of pixels on the ground.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>

#include "files/memory_budget.h"

namespace delray::image {

// Where the pixels of an elevation picture lie on the ground.
struct GeoTiff {
  // Columns: what a step to the next column adds to the coordinates, what one to the next row adds,
  // and the coordinates of the centre of pixel (0, 0).
  std::optional<glm::dmat3x2> to_ground;
  bool geographic = false;        // longitude and latitude in degrees
  std::optional<double> no_data;  // the value of pixels that were not measured
};

// Reads GeoTIFF's tags (OGC 19-008r4) and GDAL's for missing values of a file's first picture,
// whether TIFF or BigTIFF. Nothing is known of a file that is no TIFF, has no such tags or breaks
// off in them; what a stream has is kept for its next reader. A rotation is honoured; of tie points
// without a pixel size nothing is made.
GeoTiff read_geotiff(const std::filesystem::path& path, const files::MemoryBudget& memory = {});

}  // namespace delray::image
