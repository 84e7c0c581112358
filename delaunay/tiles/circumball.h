// Circumscribed balls that are certainly no smaller than they should be.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "geometry/box.h"

namespace delray::delaunay {

// The closed ball through the D + 1 corners of a simplex.
template <int D>
class Circumball {
 public:
  using Point = glm::vec<D, double, glm::defaultp>;

  explicit Circumball(const std::array<Point, D + 1>& corners);

  // Whether the ball and a box have a point in common. May be true where they have none, by a few
  // roundings; for simplices so flat that rounding hides the ball, for all boxes. Never false where
  // they have one.
  bool touches(const geometry::Box<Point>& box) const;
  // Whether the ball lies in a box, its border included: then it touches nothing beyond. May be
  // false where it does, by a few roundings; never true where it does not.
  bool is_within(const geometry::Box<Point>& box) const;

 private:
  double slack(double reach) const;

  Point corner_;          // the first one
  Point centre_;          // beside it
  double radius_ = 0;     // to the centre as computed
  double uncertain_ = 0;  // how far off the centre may be; infinite if it could be anywhere
};

// Whether a box reaches into the closed half-space beyond a facet of a convex hull. Exact.
// Facets are ordered as hull_facets() does: the outside is to the right, or where they turn left.
bool reaches_beyond(const std::array<glm::dvec2, 2>& facet, const geometry::Box<glm::dvec2>& box);
bool reaches_beyond(const std::array<glm::dvec3, 3>& facet, const geometry::Box<glm::dvec3>& box);

extern template class Circumball<2>;
extern template class Circumball<3>;

}  // namespace delray::delaunay
