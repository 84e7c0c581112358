// What the lights of a scene send to a point.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>

#include "scenes/scene.h"
#include "shading/arithmetic.h"

namespace delray::shading {

// Light that arrives from one direction, if nothing is in its way.
struct Incident {
  glm::vec3 direction{0, 0, 1};  // unit vector to the light
  float distance = std::numeric_limits<float>::infinity();
  glm::vec3 irradiance{0.0F};  // on a surface that faces the light; zero: ask no further
};

// From the light to `position`. An area light acts from its centre, as the disc of its size would
// on its axis: E = L A cos / (d^2 + A / pi), which stays finite close by. Nothing comes from a
// point light at `position` itself, from the back of an area light, or along a direction of length
// 0.
inline Incident incident(const scenes::Light& light, const glm::vec3& position) {
  Incident result;
  if (light.kind == scenes::Light::Kind::directional) {
    const float length2 = glm::dot(light.direction, light.direction);
    if (!(length2 > 0.0F)) return result;
    result.direction = light.direction * (-1.0F / std::sqrt(length2));
    result.irradiance = light.colour;
    return result;
  }
  const bool area = light.kind == scenes::Light::Kind::area;
  const glm::vec3 source =
      area ? light.position + (light.edge_u + light.edge_v) * 0.5F : light.position;
  const glm::vec3 way = source - position;
  const float distance2 = glm::dot(way, way);
  if (!(distance2 > 0.0F)) return result;
  result.distance = std::sqrt(distance2);
  result.direction = way * (1.0F / result.distance);
  if (!area) {
    result.irradiance = light.colour * (1.0F / distance2);
    return result;
  }
  const glm::vec3 normal = glm::cross(light.edge_u, light.edge_v);  // its length is the area
  const float facing = -glm::dot(normal, result.direction);
  if (!(facing > 0.0F)) return result;
  const float size = std::sqrt(glm::dot(normal, normal));
  result.irradiance = light.colour * (facing / (distance2 + size * kInversePi));
  return result;
}

}  // namespace delray::shading
