// Binds a camera to a frame of pixels, and bounds boxes in pixels by their projected corners.
//
// The bound is widened by what rounding of single-precision directions can move a pixel by, so it
// never misses one. Degenerate: a box that reaches beside or behind the eye gets all pixels, and so
// does any box where the lens has a size; a camera at its own target takes 1 for the distance.
#include "scenes/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "scenes/geometry/axes.h"

namespace delray::scenes {
namespace {

constexpr double kNearFraction = 1e-3;  // near plane, as a part of the distance to the target

double radians(double degrees) { return degrees * (std::numbers::pi / 180); }

void make_orthographic(const Camera& camera, double distance, View& view) {
  view.orthographic = true;
  view.scale = static_cast<float>(view.height) / camera.height;
  view.near = std::max(0.0F, camera.near);
  view.far = camera.far > 0 ? camera.far : static_cast<float>(2 * distance);
  if (!(view.far > view.near)) view.far = 2 * view.near + camera.height;
  view.lens_radius = 0;
  // As far as squares of distances do not overflow.
  view.viewpoint = camera.eye - view.forward * 1e18F;
}

}  // namespace

View make_view(const Camera& camera, int width, int height) {
  const glm::dvec3 to_target = glm::dvec3(camera.at) - glm::dvec3(camera.eye);
  const internal::Axes axes = internal::axes_of(to_target, camera.up);
  const double distance = glm::length(to_target);
  View view;
  view.eye = camera.eye;
  view.right = axes.right;
  view.up = axes.up;
  view.forward = axes.forward;
  view.half_width = 0.5F * static_cast<float>(width);
  view.half_height = 0.5F * static_cast<float>(height);
  view.viewpoint = camera.eye;
  view.scale = static_cast<float>(0.5 * height / std::tan(radians(camera.vertical_fov) * 0.5));
  view.near = camera.near > 0 ? camera.near
                              : static_cast<float>(kNearFraction * (distance > 0 ? distance : 1));
  view.width = width;
  view.height = height;
  view.lens_radius = 0.5F * std::max(0.0F, camera.aperture);
  view.focus_distance =
      camera.focus > 0 ? camera.focus : static_cast<float>(distance > 0 ? distance : 1);
  if (camera.orthographic()) make_orthographic(camera, distance, view);
  return view;
}

View cropped(const View& view, const geometry::Rect& window) {
  View part = view;
  part.half_width -= static_cast<float>(window.x0);
  part.half_height -= static_cast<float>(window.y0);
  part.width = window.width();
  part.height = window.height();
  return part;
}

geometry::Rect pixels_of(const View& view, const geometry::Box3& box) {
  const geometry::Rect all{0, 0, view.width, view.height};
  if (box.empty()) return {};
  if (view.lens_radius > 0) return all;
  // Directions are single floats, and none is closer to an axis than a millionth of its length.
  double margin = 1.0 + 4e-6 * view.scale;
  if (view.orthographic) {
    const glm::dvec3 way = glm::abs(glm::dvec3(box.centre()) - glm::dvec3(view.eye));
    margin = 1.0 + 8e-6 * view.scale * glm::length(way + glm::dvec3(box.size()));
  }
  glm::dvec2 low(std::numeric_limits<double>::max()), high(-low);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 at((corner & 1) != 0 ? box.high.x : box.low.x,
                        (corner & 2) != 0 ? box.high.y : box.low.y,
                        (corner & 4) != 0 ? box.high.z : box.low.z);
    const glm::dvec3 v = at - glm::dvec3(view.eye);
    const double along = glm::dot(v, glm::dvec3(view.forward));
    const double least = 1e-5 * glm::length(v);  // what is farther aside is beyond any frame
    if (!view.orthographic && !(along > least)) return all;
    const glm::dvec2 pixel(glm::dot(v, glm::dvec3(view.right)), -glm::dot(v, glm::dvec3(view.up)));
    const double w = view.orthographic ? 1 : along;
    low = glm::min(low, pixel / w);
    high = glm::max(high, pixel / w);
  }
  const glm::dvec2 half(view.half_width, view.half_height), size(view.width, view.height);
  low = glm::clamp(glm::floor(half + low * double{view.scale} - margin), glm::dvec2(0), size);
  high = glm::clamp(glm::ceil(half + high * double{view.scale} + margin), glm::dvec2(0), size);
  return {static_cast<int>(low.x), static_cast<int>(low.y), static_cast<int>(high.x),
          static_cast<int>(high.y)};
}

}  // namespace delray::scenes
