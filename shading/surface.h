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
  TexturePoint second;     // in textures of set 1; uv and footprint belong to set 0
};

// A texture at a point.
inline glm::vec4 sample(const Texture& texture, const Point& point) {
  if (texture.set == 0) return sample(texture, point.uv, point.footprint);
  return sample(texture, point.second.uv, point.second.footprint);
}

// The point with its material's textures looked up. Both normals are turned to the viewer's side.
struct Surface {
  glm::vec3 position{0.0F};
  glm::vec3 geometric_normal{0, 0, 1};
  glm::vec3 normal{0, 0, 1};  // shading normal, normal-mapped
  bool front = true;  // the viewer is on the counter-clockwise side, or the surface has no inside
  glm::vec3 base_colour{0.8F};
  float alpha = 1.0F;  // how much of what is behind is covered: 0 or 1 unless the material blends
  float metallic = 0.0F, roughness = 0.6F;
  float transmission = 0.0F, ior = 1.5F;
  bool unlit = false;  // shows nothing but its emission
  glm::vec3 emission{0.0F};
  float specular = 1.0F;
  glm::vec3 specular_colour{1.0F};
  glm::vec3 attenuation{1.0F};  // what the body behind leaves of light, by its thickness
  float clearcoat = 0.0F, clearcoat_roughness = 0.0F;
  glm::vec3 coat_normal{0, 0, 1};  // shading normal, not normal-mapped
  glm::vec3 sheen_colour{0.0F};
  float sheen_roughness = 0.0F;
};

inline bool has_specular_texture(const scenes::Material& material) {
  return material.specular_texture != scenes::kNone ||
         material.specular_colour_texture != scenes::kNone;
}

// Whether the material has a coat or a sheen anywhere.
bool is_layered(const scenes::Material& material);

// Sets what Surface says of coat and sheen. REQUIRES: surface.front is set.
void evaluate_layers(const Shader& shader, const scenes::Material& material, const Point& point,
                     Surface& surface);

// What a body of the material leaves of light after so long a way.
glm::vec3 transmittance(const scenes::Material& material, float distance);

// `view` is the unit vector from the point to the viewer.
Surface evaluate(const Shader& shader, const scenes::Material& material, const Point& point,
                 const glm::vec3& view);

// Surface::alpha alone, for rays that only ask whether something is in their way. `uv` and
// `footprint` are those of the base colour texture's set.
float coverage(const Shader& shader, const scenes::Material& material, const glm::vec2& uv,
               const Footprint& footprint, float vertex_alpha);
float coverage(const Shader& shader, const scenes::Material& material, const Point& point);

}  // namespace delray::shading
