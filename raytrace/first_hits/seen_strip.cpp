// On the screen the doubled areas A_k of a place with the three edges sum up to A, the triangle's
// own. Where Embree lets a ray pass, either no A_k is below -n or none is above n, n the error of
// an edge function (triangle_lanes.h) in this unit. So that of the longest side, of length l, is at
// most A + 2n either way: the place lies within (A + 2n) / l of the line through that side. All of
// it is computed in double from the corners that Embree sees, so that the line is good to less than
// a thousandth of a pixel all over the screen.
#include "raytrace/first_hits/seen_strip.h"

#include <algorithm>
#include <cmath>

namespace delray::raytrace {
namespace {

// As in triangle_lanes.h, with what the sums of three edge functions may be off.
constexpr double kEdgeNoise = 1.01 * 0x1p-19;

struct Strip {
  glm::dvec2 from, along;  // the line, and its direction of length 1
  double width = 0;        // on either side
  bool everywhere = false;
};

Strip strip_of(const std::array<glm::vec3, 3>& positions, const SeenFrom& from) {
  const RaySpace& space = from.space;
  Strip strip;
  strip.everywhere = true;
  glm::dvec3 corner[3];
  glm::dvec2 place[3];
  double depth[3], farthest = 0, nearest = 1e300, steepest = 0;
  for (int k = 0; k < 3; ++k) {
    corner[k] = glm::dvec3(positions[k] - space.origin);
    const double length = glm::length(corner[k]);
    depth[k] = glm::dot(corner[k], glm::dvec3(space.forward));
    if (!(depth[k] > 1e-3 * length * space.forward_length)) return strip;
    place[k] = {
        from.half_width + from.scale * glm::dot(corner[k], glm::dvec3(space.right)) / depth[k],
        from.half_height - from.scale * glm::dot(corner[k], glm::dvec3(space.up)) / depth[k]};
    farthest = std::max(farthest, length);
    nearest = std::min(nearest, length);
    steepest = std::max(steepest, std::pow(length * space.forward_length / depth[k], 2));
  }
  double longest = 0, side = 0;
  int of_side = 0;
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    longest = std::max(longest, glm::length(corner[next] - corner[k]));
    const double on_screen = glm::length(place[next] - place[k]);
    if (on_screen > side) side = on_screen, of_side = k;
  }
  const double scale = from.scale;
  const double least = std::min({depth[0], depth[1], depth[2]});
  const double area = scale * scale *
                      std::abs(glm::dot(corner[0], glm::cross(corner[1], corner[2]))) /
                      (space.volume * depth[0] * depth[1] * depth[2]);
  const double noise = scale * scale * kEdgeNoise * space.longest * longest * farthest /
                       (2 * space.volume * least * least);
  const double off = space.off_angle + space.off_length / nearest;
  strip.width = (1.01 * area + 2 * noise) / side + from.margin + scale * steepest * 4 * off;
  if (!(side > 1e-6) || !(strip.width <= kWidest)) return strip;
  strip.from = place[of_side];
  strip.along = (place[(of_side + 1) % 3] - place[of_side]) / side;
  strip.everywhere = false;
  return strip;
}

}  // namespace

void find_strip(const std::array<glm::vec3, 3>& corners, const SeenFrom& from,
                WideTriangle triangle, std::vector<WideTriangle>& seen) {
  const geometry::Rect& window = from.window;
  const auto blocks = [](int pixels) { return (pixels + kBlockSide - 1) / kBlockSide; };
  const int columns = blocks(window.width()), rows = blocks(window.height());
  const Strip strip = strip_of(corners, from);
  const auto add = [&](int x0, int y0, int x1, int y1) {
    triangle.x0 = static_cast<std::uint16_t>(x0), triangle.y0 = static_cast<std::uint16_t>(y0);
    triangle.x1 = static_cast<std::uint16_t>(x1), triangle.y1 = static_cast<std::uint16_t>(y1);
    seen.push_back(triangle);
  };
  if (strip.everywhere) return add(0, 0, columns, rows);
  const double dx = strip.along.x, dy = strip.along.y;
  for (int row = 0; row < rows; ++row) {
    // The places of the row on the line, with the strip's width around them.
    const double top = window.y0 + row * kBlockSide - strip.from.y;
    const double bottom = top + kBlockSide;
    double low, high;
    if (std::abs(dy) * 1e6 < 1) {  // level, but for a pixel in a million
      if (top * dx > strip.width + 1 && bottom * dx > strip.width + 1) continue;
      if (top * dx < -strip.width - 1 && bottom * dx < -strip.width - 1) continue;
      low = -1e9, high = 1e9;
    } else {
      const double reach = strip.width / std::abs(dy);
      low = std::min(top * dx / dy, bottom * dx / dy) - reach;
      high = std::max(top * dx / dy, bottom * dx / dy) + reach;
    }
    const double first = strip.from.x + low - window.x0, last = strip.from.x + high - window.x0;
    if (last < 0 || first > window.width()) continue;
    const int x0 = static_cast<int>(std::max(0.0, first - 1)) / kBlockSide;
    const int x1 = std::min(
        columns, static_cast<int>(std::min(last + 1, 1.0 * window.width())) / kBlockSide + 1);
    if (x0 < x1) add(x0, row, x1, row + 1);
  }
}

}  // namespace delray::raytrace
