// Whether a way of triangulating gives the simplices that another one gave.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <type_traits>
#include <vector>

#include "delaunay/combinations.h"
#include "delaunay/triangulate.h"
#include "tests/delaunay/hard_points.h"
#include "tests/delaunay/hard_points_3d.h"

namespace delray::delaunay {

// The sets of points that break triangulations of a dimension.
template <int D>
auto hard_points_of() {
  if constexpr (D == 2) {
    return hard_points();
  } else {
    return hard_points_3d();
  }
}

// What the fast method gives, which other tests compare with the definition and with CGAL.
template <class Points>
Triangulation expected_of(const Points& points, int dim) {
  Options options;
  options.dim = dim;
  return triangulate(view(points), options).triangulation;
}

template <class Points>
void expect_same(const Points& points, const Triangulation& expected, const Options& options,
                 const std::string& points_name) {
  const Triangulation actual = triangulate(view(points), options).triangulation;
  const std::string name = std::to_string(options.dim) + "D " + name_of(options) + ", " +
                           std::to_string(options.threads) + " threads, " + points_name + ", n " +
                           std::to_string(points.size()) + ", seed " + std::to_string(options.seed);
  ASSERT_EQ(hash(actual), hash(expected)) << name;
  ASSERT_EQ(actual.dim, options.dim) << name;
  ASSERT_EQ(actual.distinct, expected.distinct) << name;
  ASSERT_EQ(actual.hull_facets, expected.hull_facets) << name;
}

}  // namespace delray::delaunay
