// Points from whatever the user names: a point file, or a picture of elevations.
#pragma once

#include <string>

#include "apps/options/input_limits.h"
#include "apps/session.h"
#include "delaunay/points.h"

namespace CLI {
class App;
}

namespace delray::apps {

struct PointInput {
  std::string path;
  bool terrain_rgb = false;  // heights are coded in the colours of a picture
  double cell_size = 0;      // of an elevation picture; 0: as it says, else such that relief shows
  std::string duplicates;    // empty: first
  InputLimits limits;

  // Whether an option was given that only points have a use for.
  bool given() const { return terrain_rgb || cell_size > 0 || !duplicates.empty(); }
};

// Adds --terrain-rgb, --cell-size, --duplicates and --memory.
void add_point_options(CLI::App& command, PointInput& input);

// Whether the points are the pixels of a picture.
bool is_picture(const PointInput& input);

// Reads the points, whatever they come from. Warnings go to the log. Throws FileError and
// UsageError.
delaunay::PointCloud read_cloud(const PointInput& input);

// Merges places with several heights, with a warning. Throws UsageError.
void merge_places(const PointInput& input, delaunay::PointCloud& cloud);

// Reads the points and merges places with several heights (`dim` 2). Throws FileError and
// UsageError.
delaunay::PointCloud load_points(const PointInput& input, int dim);

// Throws FileError (memory) unless there is room to triangulate so many points in `dim` dimensions.
void require_memory_to_triangulate(const PointInput& input, std::size_t points, int dim);

// The elevations of a picture as points, row by row, z = height: x and y as a GeoTIFF says, unless
// there is a cell size; else column and -row times the cell size. Pixels that are not finite,
// transparent or marked as missing are left out. Throws FileError for a picture of colours.
delaunay::PointCloud read_elevations(const PointInput& input);

}  // namespace delray::apps
