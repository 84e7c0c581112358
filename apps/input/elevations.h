// Pictures of elevations as points.
#pragma once

#include <filesystem>

#include "delaunay/points.h"
#include "files/memory_budget.h"

namespace delray::apps {

struct ElevationOptions {
  bool terrain_rgb = false;  // heights are coded in colours
  double cell_size = 0;      // 0: as the picture says, else such that the relief shows
};

// The elevations of a picture as points, row by row, z = height: x and y as a GeoTIFF says, unless
// there is a cell size; else column and -row times the cell size. Pixels that are not finite,
// transparent or marked as missing are left out. Throws FileError for a picture of colours.
delaunay::PointCloud read_elevations(const std::filesystem::path& path,
                                     const ElevationOptions& options,
                                     const files::MemoryBudget& memory);

}  // namespace delray::apps
