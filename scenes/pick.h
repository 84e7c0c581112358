// What of a scene lies under a place in its picture.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "scenes/camera.h"
#include "scenes/scene.h"

namespace delray::scenes {

// A place on a primitive of a scene.
struct Pick {
  std::uint32_t instance = 0;
  std::uint32_t triangle = 0;  // of the instance's mesh; or the point or segment of this number
  glm::dvec3 position{0.0};    // in the scene: add Scene::origin for the file's coordinates
  glm::vec3 weights{1, 0, 0};  // of the primitive's three corners; their sum is 1
  double depth = 0;            // distance along the view
};

// The nearest primitive at position (x, y) of the view's frame, in pixels; of several equally near
// the one with the lowest number. Points and segments reach as far as they are drawn, and at least
// kPickReach pixels. Materials are not looked at: what is transparent is picked, too. Nothing where
// there is no primitive. By doubles. O(triangles of the instances whose boxes the ray meets);
// parallel.
inline constexpr float kPickReach = 3;
std::optional<Pick> pick(const Scene& scene, const View& view, float x, float y);

}  // namespace delray::scenes
