#include "scenes/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <string_view>

namespace delray::scenes {
namespace {

constexpr double kNearFraction = 1e-3;  // near plane, as a part of the distance to the target
constexpr double kFrameFill = 0.94;     // part of the frame's width or height that the box may use
constexpr double kClosest = 0.05;       // eye to nearest corner at least, in diagonals of the box
constexpr double kDefaultAzimuth = 28;  // degrees to the right of the front view
constexpr double kDefaultElevation = 18;  // degrees above the horizon, for a box as high as wide
constexpr double kFlatElevation = 34;     // the same for a box without height, seen from the side

double radians(double degrees) { return degrees * (std::numbers::pi / 180); }

glm::dvec3 normalized_or(const glm::dvec3& v, const glm::dvec3& otherwise) {
  const double length = glm::length(v);
  return length > 0 && std::isfinite(length) ? v / length : otherwise;
}

struct Axes {
  glm::dvec3 right, up, forward;
};

Axes axes_of(const glm::dvec3& to_target, const glm::dvec3& up_hint) {
  const glm::dvec3 forward = normalized_or(to_target, {0, 0, -1});
  glm::dvec3 side = glm::cross(forward, normalized_or(up_hint, {0, 1, 0}));
  if (glm::length(side) < 1e-6) {
    const bool along_z = std::abs(forward.z) > 0.9;
    side = glm::cross(forward, along_z ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1));
  }
  const glm::dvec3 right = glm::normalize(side);
  return {right, glm::cross(right, forward), forward};
}

// Where the eye stands, as a direction from the target, for y up and the front at +z.
struct Stand {
  std::string_view name;
  double azimuth, elevation;  // degrees
};
constexpr std::array
    kStands = {Stand{"front", 0, 0},     Stand{"back", 180, 0}, Stand{"left", -90, 0},
               Stand{"right", 90, 0},    Stand{"top", 0, 90},   Stand{"bottom", 0, -90},
               Stand{"iso", 45, 35.2644}};  // 35.2644: the elevation of a cube's diagonal

Stand stand_of(std::string_view name, const glm::dvec3& half, bool z_up) {
  if (name == "default") {
    const double height = z_up ? half.z : half.y;
    const double width = std::max(half.x, z_up ? half.y : half.z);
    const double flatness = 1 - std::min(1.0, height / std::max(width, 1e-300));
    return {name, kDefaultAzimuth,
            kDefaultElevation + (kFlatElevation - kDefaultElevation) * flatness};
  }
  const auto* found =
      std::find_if(kStands.begin(), kStands.end(), [&](const Stand& s) { return s.name == name; });
  if (found != kStands.end()) return *found;
  std::string message = "no view is called '" + std::string(name) + "'; views: default";
  for (const Stand& s : kStands) message += ", " + std::string(s.name);
  throw std::invalid_argument(message);
}

struct Placement {
  glm::dvec3 eye;
  double to_centre, to_nearest;  // along the view
};

// The nearest eye from which a box of half sides `half` around the origin is within `tangent` of
// the view's axis, horizontally and vertically.
//
// With the eye at (ex, ey, ef) in view coordinates a corner (r, u, f) is in the frame if
// |r - ex| <= tangent.x (f - ef). Over all corners: max(r - tangent.x f) + tangent.x ef <= ex <=
// min(r + tangent.x f) - tangent.x ef; the largest ef that leaves room for ex is the answer, and
// the same for u and ey.
Placement place(const Axes& axes, const glm::dvec3& half, const glm::dvec2& tangent) {
  constexpr double kHuge = 1e300;
  glm::dvec2 low(-kHuge), high(kHuge);
  double nearest = kHuge;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 c = half * glm::dvec3((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1,
                                           (corner & 4) != 0 ? 1 : -1);
    const glm::dvec2 across(glm::dot(c, axes.right), glm::dot(c, axes.up));
    const double along = glm::dot(c, axes.forward);
    low = glm::max(low, across - tangent * along);
    high = glm::min(high, across + tangent * along);
    nearest = std::min(nearest, along);
  }
  const glm::dvec2 room = (high - low) / (2.0 * tangent);
  const double along = std::min({room.x, room.y, nearest - kClosest * 2 * glm::length(half)});
  // Where there is room, the middle of the box comes into the middle of the frame.
  const glm::dvec2 first = low + tangent * along, last = high - tangent * along;
  const glm::dvec2 across = glm::max(first, glm::min(last, glm::dvec2(0)));
  return {axes.right * across.x + axes.up * across.y + axes.forward * along, -along,
          nearest - along};
}

}  // namespace

View make_view(const Camera& camera, int width, int height) {
  const glm::dvec3 to_target = glm::dvec3(camera.at) - glm::dvec3(camera.eye);
  const Axes axes = axes_of(to_target, camera.up);
  const double distance = glm::length(to_target);
  View view;
  view.eye = camera.eye;
  view.right = axes.right;
  view.up = axes.up;
  view.forward = axes.forward;
  view.half_width = 0.5F * static_cast<float>(width);
  view.half_height = 0.5F * static_cast<float>(height);
  view.scale = static_cast<float>(0.5 * height / std::tan(radians(camera.vertical_fov) * 0.5));
  view.near = camera.near > 0 ? camera.near
                              : static_cast<float>(kNearFraction * (distance > 0 ? distance : 1));
  view.width = width;
  view.height = height;
  view.lens_radius = 0.5F * std::max(0.0F, camera.aperture);
  view.focus_distance =
      camera.focus > 0 ? camera.focus : static_cast<float>(distance > 0 ? distance : 1);
  return view;
}

geometry::Rect pixels_of(const View& view, const geometry::Box3& box) {
  const geometry::Rect all{0, 0, view.width, view.height};
  if (box.empty()) return {};
  if (view.lens_radius > 0) return all;
  // Directions are single floats, and none is closer to an axis than a millionth of its length.
  const double margin = 1.0 + 4e-6 * view.scale;
  glm::dvec2 low(std::numeric_limits<double>::max()), high(-low);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 at((corner & 1) != 0 ? box.high.x : box.low.x,
                        (corner & 2) != 0 ? box.high.y : box.low.y,
                        (corner & 4) != 0 ? box.high.z : box.low.z);
    const glm::dvec3 v = at - glm::dvec3(view.eye);
    const double along = glm::dot(v, glm::dvec3(view.forward));
    const double least = 1e-5 * glm::length(v);  // what is farther aside is beyond any frame
    if (!(along > least)) return all;
    const glm::dvec2 pixel(glm::dot(v, glm::dvec3(view.right)), -glm::dot(v, glm::dvec3(view.up)));
    low = glm::min(low, pixel / along);
    high = glm::max(high, pixel / along);
  }
  const glm::dvec2 half(view.half_width, view.half_height), size(view.width, view.height);
  low = glm::clamp(glm::floor(half + low * double{view.scale} - margin), glm::dvec2(0), size);
  high = glm::clamp(glm::ceil(half + high * double{view.scale} + margin), glm::dvec2(0), size);
  return {static_cast<int>(low.x), static_cast<int>(low.y), static_cast<int>(high.x),
          static_cast<int>(high.y)};
}

Camera camera_around(const geometry::Box3& bounds, const char* name, bool z_up, float aspect) {
  glm::dvec3 centre(0), half(0.5);
  if (!bounds.empty()) {
    centre = (glm::dvec3(bounds.low) + glm::dvec3(bounds.high)) * 0.5;
    half = (glm::dvec3(bounds.high) - glm::dvec3(bounds.low)) * 0.5;
    // A single point: what is around it is shown, on a scale that its floats can resolve.
    const double smallest = 1e-5 * glm::length(centre);
    if (glm::length(half) <= smallest) half += glm::dvec3(smallest > 0 ? smallest : 0.5);
  }

  const Stand stand = stand_of(name, half, z_up);
  const double azimuth = radians(stand.azimuth), elevation = radians(stand.elevation);
  const bool vertical = std::abs(stand.elevation) == 90;
  const double level = vertical ? 0 : std::cos(elevation);
  const auto oriented = [z_up](const glm::dvec3& v) {
    return z_up ? glm::dvec3(v.x, -v.z, v.y) : v;
  };
  const glm::dvec3 towards_eye =
      oriented({level * std::sin(azimuth), std::sin(elevation), level * std::cos(azimuth)});
  const glm::dvec3 up =
      oriented(vertical ? glm::dvec3(0, 0, -std::copysign(1.0, elevation)) : glm::dvec3(0, 1, 0));

  Camera camera;
  const Axes axes = axes_of(-towards_eye, up);
  const double tangent = kFrameFill * std::tan(radians(camera.vertical_fov) * 0.5);
  const Placement placement = place(axes, half, {tangent * (aspect > 0 ? aspect : 1.0), tangent});
  camera.eye = centre + placement.eye;
  camera.at = centre + placement.eye + axes.forward * placement.to_centre;
  camera.up = up;
  camera.near =
      static_cast<float>(std::min(kNearFraction * placement.to_centre, 0.5 * placement.to_nearest));
  return camera;
}

}  // namespace delray::scenes
