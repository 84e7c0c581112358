// Transforms of nodes, and what becomes of instances, lights and cameras by them.
#include "scenes/animation/followers.h"

#include <algorithm>
#include <glm/gtc/quaternion.hpp>
#include <utility>

namespace delray::scenes::internal {
namespace {

glm::dvec3 unit_or(const glm::dvec3& v, const glm::dvec3& otherwise) {
  const double length = glm::length(v);
  return length > 0 ? v / length : otherwise;
}

}  // namespace

glm::dmat4 transform_of(const AnimatedNode& node) {
  if (node.matrix) return *node.matrix;
  glm::dmat4 transform(1.0);
  const glm::dvec4& q = node.rotation;
  const double length = glm::length(q);
  if (length > 0) transform = glm::mat4_cast(glm::dquat(q.w, q.x, q.y, q.z) / length);
  for (int k = 0; k < 3; ++k) transform[k] *= node.scale[k];
  transform[3] = glm::dvec4(node.translation, 1.0);
  return transform;
}

glm::mat4x3 placed_at(const glm::dmat4& world, const glm::dvec3& centre, const glm::dvec3& origin) {
  glm::dmat4 moved = world;
  if (centre != glm::dvec3(0)) moved[3] = world * glm::dvec4(centre, 1.0);
  moved[3] -= glm::dvec4(origin, 0.0);
  return glm::mat4x3(glm::dmat4x3(moved));
}

bool follow(const glm::dmat4& world, Light& light) {
  const glm::vec3 position = glm::dvec3(world[3]);
  const glm::vec3 direction = -unit_or(glm::dvec3(world[2]), {0, 0, 1});
  const bool moved = position != light.position || direction != light.direction;
  light.position = position;
  light.direction = direction;
  return moved;
}

bool follow(const glm::dmat4& world, Camera& camera) {
  const Camera before = camera;
  camera.eye = glm::dvec3(world[3]);
  // Far enough from the eye for the direction to keep its precision.
  const double distance = std::max(1.0, glm::length(glm::dvec3(world[3])));
  camera.at = glm::dvec3(world[3]) - unit_or(glm::dvec3(world[2]), {0, 0, 1}) * distance;
  camera.up = unit_or(glm::dvec3(world[1]), {0, 1, 0});
  return camera.eye != before.eye || camera.at != before.at || camera.up != before.up;
}

}  // namespace delray::scenes::internal
