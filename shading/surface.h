// What a material is at one point.
#pragma once

#include <glm/glm.hpp>

#include "shading/shader.h"

namespace delray::shading {

// What a renderer knows about a point that it sees. Directions have unit length and belong to the
// triangle as it stands in the world, whichever side is seen.
struct Point {
  glm::vec3 position{0.0F};
  glm::vec3 geometric_normal{0, 0, 1};  // of the counter-clockwise side
  glm::vec3 normal{0, 0, 1};            // interpolated; the geometric one where the mesh has none
  glm::vec4 tangent{0.0F};              // w: handedness, 0 where the mesh has none
  glm::vec2 uv{0.0F};
  Footprint footprint;
  glm::vec4 colour{1.0F};  // of the vertices
};

// The point with its material's textures looked up. Both normals are turned to the viewer's side.
struct Surface {
  glm::vec3 position{0.0F};
  glm::vec3 geometric_normal{0, 0, 1};
  glm::vec3 normal{0, 0, 1};  // shading normal, normal-mapped
  bool front = true;          // the viewer is on the counter-clockwise side
  glm::vec3 base_colour{0.8F};
  float alpha = 1.0F;  // how much of what is behind is covered: 0 or 1 unless the material blends
  float metallic = 0.0F, roughness = 0.6F;
  float transmission = 0.0F, ior = 1.5F;
  glm::vec3 emission{0.0F};
};

// `view` is the unit vector from the point to the viewer.
Surface evaluate(const Shader& shader, const scenes::Material& material, const Point& point,
                 const glm::vec3& view);

// Surface::alpha alone, for rays that only ask whether something is in their way.
float coverage(const Shader& shader, const scenes::Material& material, const glm::vec2& uv,
               const Footprint& footprint, float vertex_alpha);

}  // namespace delray::shading
