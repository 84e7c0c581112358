// Fits a camera to points from a given side.
//
// With the eye at (ex, ey, ef) in view coordinates a point (r, u, f) is within `tangent` of the
// view's axis if |r - ex| <= tangent.x (f - ef). Over all points:
//   max(r - tangent.x f) + tangent.x ef <= ex <= min(r + tangent.x f) - tangent.x ef.
// The largest ef that leaves room for ex is the solution, and the same for u and ey: maxima along
// four directions tell it. Where there is room left (in the direction that does not fill the
// frame) the points come into its middle by making the tangent smaller until there is none.
#include "scenes/framing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "files/similar_name.h"
#include "scenes/geometry/axes.h"

namespace delray::scenes {
namespace {

using internal::Axes;

constexpr double kMargin = 0.05;          // of the frame's width or height, on either side
constexpr double kNearPlane = 1e-3;       // as a part of the distance to the target
constexpr double kClosest = 0.05;         // eye to nearest point at least, in diagonals of the box
constexpr double kDefaultAzimuth = 28;    // degrees to the right of the front view
constexpr double kDefaultElevation = 18;  // degrees above the horizon, for a box as high as wide
constexpr double kFlatElevation = 34;     // the same for a box without height, seen from the side

double radians_of(double degrees) { return degrees * (std::numbers::pi / 180); }

// Where the eye stands, as a direction from the target, for y up and the front at +z.
struct Stand {
  std::string_view name;
  double azimuth, elevation;  // degrees
};
constexpr std::array
    kStands = {Stand{"front", 0, 0},     Stand{"back", 180, 0}, Stand{"left", -90, 0},
               Stand{"right", 90, 0},    Stand{"top", 0, 90},   Stand{"bottom", 0, -90},
               Stand{"iso", 45, 35.2644}};  // 35.2644: the elevation of a cube's diagonal

Stand stand_of(std::string_view name, const glm::dvec3& size, bool z_up) {
  if (name == "default") {
    const double height = z_up ? size.z : size.y;
    const double width = std::max(size.x, z_up ? size.y : size.z);
    const double flatness = 1 - std::min(1.0, height / std::max(width, 1e-300));
    return {name, kDefaultAzimuth,
            kDefaultElevation + (kFlatElevation - kDefaultElevation) * flatness};
  }
  const auto* found = std::ranges::find(kStands, name, &Stand::name);
  if (found != kStands.end()) return *found;
  std::string message = "no view is called '" + std::string(name) + "'; views:";
  const std::vector<std::string> names = view_names();
  for (const std::string& legal : names) message += (&legal == &names[0] ? " " : ", ") + legal;
  throw std::invalid_argument(message + files::did_you_mean(name, names));
}

struct Orientation {
  Axes axes;
  glm::dvec3 up;  // of the scene
};

Orientation orientation_of(const Stand& stand, bool z_up) {
  const double azimuth = radians_of(stand.azimuth), elevation = radians_of(stand.elevation);
  const bool vertical = std::abs(stand.elevation) == 90;
  const double level = vertical ? 0 : std::cos(elevation);
  const auto oriented = [z_up](const glm::dvec3& v) {
    return z_up ? glm::dvec3(v.x, -v.z, v.y) : v;
  };
  const glm::dvec3 towards_eye =
      oriented({level * std::sin(azimuth), std::sin(elevation), level * std::cos(azimuth)});
  const glm::dvec3 up =
      oriented(vertical ? glm::dvec3(0, 0, -std::copysign(1.0, elevation)) : glm::dvec3(0, 1, 0));
  return {internal::axes_of(-towards_eye, up), up};
}

// Points that say where an eye may be from which all are within a tangent of the view's axis.
struct Limits {
  glm::dvec2 low, high;       // max(across - tangent along), min(across + tangent along)
  glm::dvec2 across_between;  // of the points of `low` and `high`, from one to the other
  glm::dvec2 along_both;      // sum over the two
  double nearest, farthest;   // along the view
};

class Fit {
 public:
  Fit(const FarthestPoints& farthest, const Axes& axes, const glm::dvec3& centre)
      : farthest_(farthest), axes_(axes), centre_(centre) {}

  Limits limits(const glm::dvec2& tangent) const {
    const glm::dvec3 right = axes_.right, up = axes_.up, forward = axes_.forward;
    const glm::dvec3 directions[] = {right - forward * tangent.x,
                                     -right - forward * tangent.x,
                                     up - forward * tangent.y,
                                     -up - forward * tangent.y,
                                     -forward,
                                     forward};
    std::array<glm::dvec3, 6> v;  // in view coordinates
    const std::vector<glm::dvec3> points = farthest_(directions);
    for (std::size_t i = 0; i < v.size(); ++i) {
      const glm::dvec3 p = points[i] - centre_;
      v[i] = {glm::dot(p, right), glm::dot(p, up), glm::dot(p, forward)};
    }
    return {{v[0].x - tangent.x * v[0].z, v[2].y - tangent.y * v[2].z},
            {v[1].x + tangent.x * v[1].z, v[3].y + tangent.y * v[3].z},
            {v[0].x - v[1].x, v[2].y - v[3].y},
            {v[0].z + v[1].z, v[2].z + v[3].z},
            v[4].z,
            v[5].z};
  }

  // Across the view, of an eye at `eye_along`: in the middle between the points as they are seen.
  //
  // For a pair of points the room that they leave, high - low - 2 tangent eye_along, is linear in
  // the tangent; over all pairs it is concave. A step of Newton's method from a tangent that leaves
  // room leads to one that leaves none, from there on the tangents grow, and meet the one that is
  // sought after finitely many steps (Dinkelbach 1967), three as a rule.
  glm::dvec2 middle(Limits now, glm::dvec2 tangent, double eye_along) const {
    constexpr int kSteps = 12;
    constexpr double kExact = 1e-7;  // of the tangent; 1e-4 pixels
    for (int step = 0; step < kSteps; ++step) {
      const glm::dvec2 next = now.across_between / (now.along_both - 2 * eye_along);
      const bool there = glm::all(glm::lessThanEqual(glm::abs(next - tangent), kExact * tangent));
      if (there) break;
      tangent = next;
      now = limits(tangent);
    }
    return ((now.low + tangent * eye_along) + (now.high - tangent * eye_along)) * 0.5;
  }

 private:
  const FarthestPoints& farthest_;
  const Axes& axes_;
  glm::dvec3 centre_;
};

Camera fitted(const FarthestPoints& farthest, const geometry::Box3& box, const Stand& stand,
              bool z_up, double aspect) {
  const Orientation orientation = orientation_of(stand, z_up);
  const Axes& axes = orientation.axes;
  const glm::dvec3 centre = (glm::dvec3(box.low) + glm::dvec3(box.high)) * 0.5;
  const double diagonal = glm::length(glm::dvec3(box.high) - glm::dvec3(box.low));
  Camera camera;
  const double half_frame = std::tan(radians_of(camera.vertical_fov) * 0.5);
  const glm::dvec2 tangent = glm::dvec2(half_frame * aspect, half_frame) * (1 - 2 * kMargin);

  const Fit fit(farthest, axes, centre);
  const Limits limits = fit.limits(tangent);
  const glm::dvec2 room = (limits.high - limits.low) / (2.0 * tangent);
  const double along = std::min({room.x, room.y, limits.nearest - kClosest * diagonal});
  const glm::dvec2 across = fit.middle(limits, tangent, along);

  const glm::dvec3 eye = centre + axes.right * across.x + axes.up * across.y + axes.forward * along;
  const double to_target = (limits.nearest + limits.farthest) * 0.5 - along;
  camera.eye = eye;
  camera.at = eye + axes.forward * to_target;
  camera.up = orientation.up;
  camera.near =
      static_cast<float>(std::min(kNearPlane * to_target, 0.5 * (limits.nearest - along)));
  return camera;
}

}  // namespace

std::vector<std::string> view_names() {
  std::vector<std::string> names = {"default"};
  for (const Stand& stand : kStands) names.emplace_back(stand.name);
  return names;
}

Camera camera_around(const FarthestPoints& farthest, const char* name, bool z_up, float aspect) {
  geometry::Box3 box = bounds(farthest);
  const double frame_aspect = aspect > 0 ? aspect : 1.0;
  const auto size = [&] { return glm::dvec3(box.high) - glm::dvec3(box.low); };
  if (box.empty()) box.include(glm::vec3(0));
  // A single point: what is around it is shown, on a scale that its floats can resolve.
  const double smallest = 1e-5 * glm::length((glm::dvec3(box.low) + glm::dvec3(box.high)) * 0.5);
  if (!(glm::length(size()) > 2 * smallest)) {
    const auto around = static_cast<float>(smallest > 0 ? smallest : 0.5);
    box = {box.low - around, box.high + around};
    const auto corners = [&box](std::span<const glm::dvec3> directions) {
      return farthest_corners(box, directions);
    };
    return fitted(corners, box, stand_of(name, size(), z_up), z_up, frame_aspect);
  }
  return fitted(farthest, box, stand_of(name, size(), z_up), z_up, frame_aspect);
}

Camera camera_around(const geometry::Box3& box, const char* name, bool z_up, float aspect) {
  return camera_around(FarthestPoints([&box](std::span<const glm::dvec3> directions) {
                         return farthest_corners(box, directions);
                       }),
                       name, z_up, aspect);
}

FarthestPoints turned(const FarthestPoints& farthest, const glm::dvec3& axis, int turns) {
  const geometry::Box3 box = bounds(farthest);
  const glm::dvec3 middle = (glm::dvec3(box.low) + glm::dvec3(box.high)) * 0.5;
  const auto rotated = [unit = glm::normalize(axis)](const glm::dvec3& v, double angle) {
    // Rodrigues' rotation.
    return v * std::cos(angle) + glm::cross(unit, v) * std::sin(angle) +
           unit * (glm::dot(unit, v) * (1 - std::cos(angle)));
  };
  return [=, &farthest](std::span<const glm::dvec3> directions) {
    const std::size_t n = directions.size();
    std::vector<glm::dvec3> all;  // as the points see them: turn after turn
    const auto angle = [turns](std::size_t turn) {
      return 2 * std::numbers::pi * static_cast<double>(turn) / turns;
    };
    const auto count = static_cast<std::size_t>(turns);
    for (std::size_t turn = 0; turn < count; ++turn) {
      for (const glm::dvec3& d : directions) all.push_back(rotated(d, -angle(turn)));
    }
    const std::vector<glm::dvec3> points = farthest(all);
    std::vector<glm::dvec3> result;
    for (std::size_t turn = 0; turn < count && !points.empty(); ++turn) {
      std::vector<glm::dvec3> candidates;
      for (std::size_t k = 0; k < n; ++k) {
        candidates.push_back(middle + rotated(points[turn * n + k] - middle, angle(turn)));
      }
      keep_farthest(directions, candidates, result);
    }
    return result;
  };
}

Camera camera_around(const Scene& scene, const char* name, float aspect) {
  return camera_around(FarthestPoints(Extent(scene)), name, scene.z_up, aspect);
}

}  // namespace delray::scenes
