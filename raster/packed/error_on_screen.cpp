// An error moves what is seen by as much in the world. On the screen that is its share of the
// distance along the view axis, and more away from the axis: a step towards the eye there moves
// sideways, too. The step that moves most is sqrt(1 + t^2) times as long on the screen as on the
// axis, t being the tangent of the angle to it.
//
// Bounds of what is linear in a box take each coordinate at one of its ends, and all else that is
// done to them is monotone, also as it is rounded: so a box within another never has larger errors.
//
// Degenerate: what reaches before the near plane counts as if it were at it; transforms that are
// skew stretch by no more than the root of the sum of squares of their axes.
#include "raster/packed/error_on_screen.h"

#include <algorithm>
#include <cmath>

namespace delray::raster {
namespace {

constexpr float kRoundingOfErrors = 1e-4F;

float stretch_of(const glm::mat4x3& transform) {
  const glm::dmat3 axes{glm::mat3(transform)};
  double sum = 0, longest = 0, skew = 0;
  for (int k = 0; k < 3; ++k) {
    const double squared = glm::dot(axes[k], axes[k]);
    sum += squared;
    longest = std::max(longest, squared);
    skew = std::max(skew, std::abs(glm::dot(axes[k], axes[(k + 1) % 3])));
  }
  const bool at_right_angles = skew <= 1e-6 * longest;
  return static_cast<float>(std::sqrt(at_right_angles ? longest : sum));
}

// The least of row * (p, 1) for all p of the box.
float least(const glm::vec4& row, const geometry::Box3& box) {
  float sum = row.w;
  for (int k = 0; k < 3; ++k) sum += row[k] * (row[k] > 0 ? box.low[k] : box.high[k]);
  return sum;
}

// The largest of its absolute values.
float farthest(const glm::vec4& row, const geometry::Box3& box) {
  return std::max(-least(row, box), -least(-row, box));
}

}  // namespace

ErrorOnScreen::ErrorOnScreen(const Screen& screen, const PreparedDraw& draw, double most)
    : screen_(screen), draw_(draw) {
  const scenes::View& view = screen.view;
  // Of the whole frame, so that a window of it shows the same levels.
  const geometry::Rect& frame = screen.whole;
  frame_ = glm::vec2(std::max(view.half_width - static_cast<float>(frame.x0),
                              static_cast<float>(frame.x1) - view.half_width),
                     std::max(view.half_height - static_cast<float>(frame.y0),
                              static_cast<float>(frame.y1) - view.half_height)) /
           view.scale;
  factor_ = stretch_of(*draw.draw->transform) * view.scale * (1 + kRoundingOfErrors) /
            static_cast<float>(most);
}

bool ErrorOnScreen::allows(float error, const geometry::Box3& bounds) const {
  if (screen_.view.orthographic) return error * factor_ <= 1;
  const glm::vec4* const row = draw_.to_view.row;
  const float z = std::max(least(row[2], bounds), screen_.view.near);
  const float x = std::min(farthest(row[0], bounds) / z, frame_.x);
  const float y = std::min(farthest(row[1], bounds) / z, frame_.y);
  return error * factor_ * std::sqrt(1 + x * x + y * y) <= z;
}

}  // namespace delray::raster
