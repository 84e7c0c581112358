// An error moves what is seen by as much in the world, and that by at most its share of the
// distance on the screen, a little more towards the corners of the frame.
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

}  // namespace

ErrorOnScreen::ErrorOnScreen(const Screen& screen, const PreparedDraw& draw, double most)
    : screen_(screen), draw_(draw) {
  const scenes::View& view = screen.view;
  // Of the whole frame, so that a window of it shows the same levels.
  const geometry::Rect& frame = screen.whole;
  const float x = std::max(view.half_width - static_cast<float>(frame.x0),
                           static_cast<float>(frame.x1) - view.half_width);
  const float y = std::max(view.half_height - static_cast<float>(frame.y0),
                           static_cast<float>(frame.y1) - view.half_height);
  const float slant =
      view.orthographic ? 1.0F : std::sqrt(1 + (x * x + y * y) / (view.scale * view.scale));
  factor_ = stretch_of(*draw.draw->transform) * view.scale * slant * (1 + kRoundingOfErrors) /
            static_cast<float>(most);
  along_ = glm::abs(glm::vec3(draw.to_view.row[2]));
  length_ = glm::length(along_);
}

float ErrorOnScreen::distance(const glm::vec3& centre, float reach) const {
  if (screen_.view.orthographic) return 1;
  const glm::vec4& row = draw_.to_view.row[2];
  return std::max(glm::dot(glm::vec3(row), centre) + row.w - reach, screen_.view.near);
}

}  // namespace delray::raster
