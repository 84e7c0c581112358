// Points from whatever the user names: a point file, or a picture of elevations.
#pragma once

#include <string>

#include "apps/input_limits.h"
#include "apps/session.h"
#include "delaunay/points.h"

namespace CLI {
class App;
}

namespace delray::apps {

struct PointInput {
  std::string path;
  bool terrain_rgb = false;  // heights are coded in the colours of a picture
  double cell_size = 0;      // of an elevation picture; 0: such that the relief looks like one
  std::string duplicates;    // empty: first
  InputLimits limits;

  // Whether an option was given that only points have a use for.
  bool given() const { return terrain_rgb || cell_size > 0 || !duplicates.empty(); }
};

// Adds --terrain-rgb, --cell-size, --duplicates and --memory.
void add_point_options(CLI::App& command, PointInput& input);

// Reads the points and merges places with several heights (`dim` 2), with a warning. Throws
// FileError and UsageError.
delaunay::PointCloud load_points(const PointInput& input, int dim);

// The elevations of a picture as points, row by row: x = column, y = -row, both times the cell
// size, z = height; pixels that are not finite are left out.
delaunay::PointCloud read_elevations(const PointInput& input);

}  // namespace delray::apps
