// When a triangle is to be cut, and where.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <numbers>

namespace delray::delaunay::internal {

// What is to be done first: larger values of `urgency` before smaller ones; 0 for nothing.
constexpr unsigned kMostUrgent = 127;

struct TriangleShape {
  double smallest_sine = 0;  // squared, of the smallest angle
  double area = 0;
  double circle = 0;      // squared radius of the circumscribed one
  unsigned shortest = 0;  // the edge opposite to this corner
};

// Squares of lengths and areas, of corners that turn left.
inline TriangleShape shape_of_triangle(const glm::dvec2& a, const glm::dvec2& b,
                                       const glm::dvec2& c) {
  const glm::dvec2 opposite[3] = {c - b, a - c, b - a};
  double squares[3];
  for (int k = 0; k < 3; ++k) squares[k] = glm::dot(opposite[k], opposite[k]);
  unsigned shortest = squares[1] < squares[0] ? 1 : 0;
  if (squares[2] < squares[shortest]) shortest = 2;
  const double twice = opposite[2].x * -opposite[1].y + opposite[2].y * opposite[1].x;
  const double others = squares[(shortest + 1) % 3] * squares[(shortest + 2) % 3];
  const double sine = others > 0 ? twice * twice / others : 0;
  return {sine, twice / 2, squares[shortest] / (4 * sine), shortest};
}

// What makes a triangle large, and where it is cut.
enum class Measure : std::uint8_t {
  area,    // at off-centres (Üngör 2004)
  circle,  // by the radius of its circle, at circumcentres (Chew 1989)
};

// The bounds of a refinement.
class TriangleBounds {
 public:
  // Degrees, and an area or 0 for none: with circles that of the regular triangle in the largest.
  TriangleBounds(double min_angle, double max_area, Measure measure)
      : most_(measure == Measure::area ? max_area : 4 / (3 * std::numbers::sqrt3) * max_area),
        measure_(measure) {
    // A little more than asked for, so that rounding does not tell.
    const double radians = min_angle * (1 + 0x1p-40) * (std::numbers::pi / 180);
    sine_ = std::sin(radians) * std::sin(radians);
    // Slightly lower than where the angle at the off-centre is the bound.
    constexpr double kBelow = 0.95;
    height_ = min_angle > 0 ? kBelow / (2 * std::tan(radians / 2)) : 0;
  }

  bool is_large(const TriangleShape& shape) const { return most_ > 0 && size(shape) > most_; }
  // About how many triangles of the largest size there are in one; 0 without that bound.
  double pieces(const TriangleShape& shape) const { return most_ > 0 ? size(shape) / most_ : 0; }
  bool is_skinny(const TriangleShape& shape) const { return shape.smallest_sine < sine_; }

  // Large triangles come first, the largest of them before others, then skinny ones, the worst
  // first: so that fewer points do.
  unsigned urgency(const TriangleShape& shape) const {
    constexpr unsigned kOfAngles = 64;
    if (is_large(shape)) {
      const int doublings = std::ilogb(std::min(size(shape) / most_, 0x1p100));
      return std::min(kMostUrgent, kOfAngles + 1 + static_cast<unsigned>(std::max(0, doublings)));
    }
    if (!is_skinny(shape)) return 0;
    return kOfAngles - static_cast<unsigned>(shape.smallest_sine / sine_ * (kOfAngles - 1));
  }

  // The off-centre of a skinny triangle: on the bisector of its shortest edge p q towards the
  // circumcentre, but no farther than where the edge is seen at the bound (Üngör 2004). The
  // circumcentre of one that is only large, or where circles are measured.
  glm::dvec2 place_in(const TriangleShape& shape, const glm::dvec2& p, const glm::dvec2& q,
                      const glm::dvec2& apex) const {
    const glm::dvec2 edge = q - p, side = apex - p;
    const double twice = edge.x * side.y - edge.y * side.x;
    const double along = glm::dot(side, side - edge) / (2 * twice);  // in edges, to the left
    const double most =
        is_skinny(shape) && measure_ == Measure::area ? std::min(along, height_) : along;
    return p + 0.5 * edge + most * glm::dvec2(-edge.y, edge.x);
  }

 private:
  double size(const TriangleShape& shape) const {
    return measure_ == Measure::area ? shape.area : shape.circle;
  }

  double sine_, height_, most_;
  Measure measure_;
};

}  // namespace delray::delaunay::internal
