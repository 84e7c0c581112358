// Projection of bounds. What is left of a convex hull in front of a plane is the hull of its
// vertices there and of the points where the edges from those in front to those behind meet the
// plane; all pairs of vertices do for edges, as the others lie inside.
//
// Degenerate: coordinates that are not finite count for nothing. As with IceT a vertex of which
// nobody can say on which side of the plane it lies is on both: the nearest depth is that of the
// plane then.
#include "icet/viewport.h"

#include <algorithm>
#include <cmath>

namespace delray::icet {
namespace {

constexpr double kSmallestPart = 1e-5;  // of a pixel, less is rounding

// Of normalised coordinates; as long as nothing is seen it is less than nothing.
struct Extent {
  double low = 1, high = -1;
  void add(double value) {
    if (value < low) low = value;  // never NaN
    if (value > high) high = value;
  }
};

// Normalised coordinates become pixels.
int pixel(double normalised, int begin, int size, double rounding, double (*round)(double)) {
  const double at = begin + (std::clamp(normalised, -1.0, 1.0) + 1) / 2 * size;
  return static_cast<int>(round(at + rounding));
}
double down(double value) { return std::floor(value); }
double up(double value) { return std::ceil(value); }

}  // namespace

Projected project(std::span<const glm::dvec3> bounds, const glm::dmat4& clip_from_object,
                  const geometry::Rect& display) {
  if (bounds.empty()) return {display, -1, 1};
  std::vector<glm::dvec4> vertices;
  for (const glm::dvec3& vertex : bounds) {
    vertices.push_back(clip_from_object * glm::dvec4(vertex, 1));
  }
  Extent x, y, z;
  const auto add = [&](const glm::dvec4& clip) {
    if (!(clip.w > 0)) return;  // only at the eye
    x.add(clip.x / clip.w);
    y.add(clip.y / clip.w);
    z.add(clip.z / clip.w);
  };
  for (const glm::dvec4& a : vertices) {
    const double from_a = a.z + a.w;  // to the near plane
    if (from_a >= 0) {
      add(a);
      continue;
    }
    for (const glm::dvec4& b : vertices) {
      const double from_b = b.z + b.w;
      if (from_b < 0) continue;
      add(b + (a - b) * (from_b / (from_b - from_a)));
      z.add(-1);
    }
  }
  const int width = display.width(), height = display.height();
  return {{pixel(x.low, display.x0, width, kSmallestPart, &down),
           pixel(y.low, display.y0, height, kSmallestPart, &down),
           pixel(x.high, display.x0, width, -kSmallestPart, &up),
           pixel(y.high, display.y0, height, -kSmallestPart, &up)},
          std::clamp(z.low, -1.0, 1.0),
          std::clamp(z.high, -1.0, 1.0)};
}

glm::dmat4 projection_of(const geometry::Rect& part, const geometry::Rect& display,
                         const glm::dmat4& projection) {
  // Coordinates of the part are scale * those of the display + shift.
  glm::dmat4 change(1);
  const auto set = [&](int axis, int begin, int size, int all_begin, int all_size) {
    change[axis][axis] = static_cast<double>(all_size) / size;
    change[3][axis] = (2.0 * (all_begin - begin) + all_size) / size - 1;
  };
  set(0, part.x0, part.width(), display.x0, display.width());
  set(1, part.y0, part.height(), display.y0, display.height());
  return change * projection;
}

std::vector<int> tiles_to_draw(const Context& context, const geometry::Rect& contained) {
  const std::vector<int>& group = context.replication;
  const int me = context.ranks->rank();
  std::vector<int> tiles;
  for (std::size_t i = 0; i < context.settings.tiles.size(); ++i) {
    const Tile& tile = context.settings.tiles[i];
    if (!is_in(contained, tile.place)) continue;
    const bool shown_by_one = std::find(group.begin(), group.end(), tile.display) != group.end();
    if ((shown_by_one ? tile.display : group[i % group.size()]) == me)
      tiles.push_back(static_cast<int>(i));
  }
  return tiles;
}

}  // namespace delray::icet
