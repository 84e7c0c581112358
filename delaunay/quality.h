// Shape measures of the simplices of a triangulation: angles and radius ratios.
#pragma once

#include <array>
#include <cstddef>

#include "delaunay/points.h"
#include "delaunay/triangulation.h"

namespace delray::delaunay {

// Measures of how well the simplices of a mesh are shaped.
struct Quality {
  std::size_t simplices = 0;
  // Angles in degrees: the three of a triangle, or the six dihedral angles of a tetrahedron. The
  // minima and maxima are over all simplices; the mean is that of the smallest angle of each.
  double min_angle = 0, max_angle = 0, mean_min_angle = 0;
  // dim times the radius of the inscribed over that of the circumscribed sphere: 1 if regular, 0
  // if flat.
  double min_radius_ratio = 0, mean_radius_ratio = 0;
  // Counts of all angles by tens of degrees and of simplices by tenths of the ratio; what lies on
  // a bound counts above it, but for 180 degrees and 1.
  std::array<std::size_t, 18> angles{};
  std::array<std::size_t, 10> radius_ratios{};
};

// In floating point: angles and ratios are within some units of rounding of the simplex's
// coordinates. The same for every number of threads. All 0 without simplices. O(n), parallel.
Quality quality(PointView<double> points, const Triangulation& triangulation);

}  // namespace delray::delaunay
