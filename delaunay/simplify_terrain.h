// Terrains of fewer points that stay within a bound of all of them.
#pragma once

#include <cstdint>
#include <vector>

#include "delaunay/points.h"
#include "delaunay/triangulation.h"
#include "parallel/progress.h"

namespace delray::delaunay {

// The points that were kept, and their triangulation.
struct SimplifiedTerrain {
  std::vector<std::uint32_t> kept;  // rows, ascending
  // triangulate() of the kept points: vertices are rows of all points, `distinct` counts all places
  // (x, y).
  Triangulation triangulation;
  double largest_error = 0;  // of a place that was not kept, in floating point
};

// Keeps the corners of the convex hull in x and y, and then, one after the other, the point that is
// farthest above or below the surface so far, in z, until none is farther than `max_error` (Puppo,
// Davis, De Menthon and Teng 1994; Garland and Heckbert 1995). Whether a point is within the bound
// is decided exactly, so it holds for every place without rounding; 0 leaves out only points that
// lie exactly on the surface. Of several rows at one place the lowest counts, as everywhere. The
// result depends on nothing but the points. Nothing is kept of places that are all on one line.
//
// With several threads parts of the terrain insert their own farthest points at the same time, all
// points beyond some error before those within half of it. That keeps a few more points, the same
// ones for every number of threads above one, and the same bound.
//
// O(n log n) for usual terrains, O(n) a point that is kept at worst; about 50 bytes a point.
// `progress`, if not null, counts the points that are settled.
//
// Errors: std::invalid_argument for a coordinate that is not finite (names the row), for a bound
// that is negative or not finite, for threads below 1 or above kMostThreads, for points without
// three coordinates, for more than 2^29 points; parallel::Interrupted.
SimplifiedTerrain simplify_terrain(PointView<double> points, double max_error,
                                   parallel::Progress* progress = nullptr, int threads = 1);

// The rows of a cloud, with all their attributes, in the order of `rows`.
PointCloud select_rows(const PointCloud& cloud, const std::vector<std::uint32_t>& rows);

}  // namespace delray::delaunay
