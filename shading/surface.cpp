#include "shading/surface.h"

#include <cmath>

#include "shading/arithmetic.h"

namespace delray::shading {
namespace {

using Alpha = scenes::Material::Alpha;

float resolve_alpha(const scenes::Material& material, float alpha) {
  switch (material.alpha) {
    case Alpha::opaque:
      break;
    case Alpha::mask:
      return alpha >= material.alpha_cutoff ? 1.0F : 0.0F;
    case Alpha::blend:
      return clamp01(alpha);
  }
  return 1.0F;
}

glm::vec3 normal_mapped(const Shader& shader, const scenes::Material& material,
                        const Point& point) {
  const glm::vec3 tangent(point.tangent);
  const glm::vec3 bitangent = glm::cross(point.normal, tangent) * point.tangent.w;
  const glm::vec4 texel =
      sample(shader.textures[material.normal_texture], point.uv, point.footprint);
  const float x = (2.0F * texel.x - 1.0F) * material.normal_scale;
  const float y = (2.0F * texel.y - 1.0F) * material.normal_scale;
  const float z = 2.0F * texel.z - 1.0F;
  const glm::vec3 mapped = tangent * x + bitangent * y + point.normal * z;
  const float squared = glm::dot(mapped, mapped);
  return squared > 0.0F ? mapped * (1.0F / std::sqrt(squared)) : point.normal;
}

}  // namespace

Surface evaluate(const Shader& shader, const scenes::Material& material, const Point& point,
                 const glm::vec3& view) {
  Surface surface;
  surface.position = point.position;
  surface.front = glm::dot(point.geometric_normal, view) >= 0.0F;
  glm::vec3 normal = point.normal;
  if (material.normal_texture != scenes::kNone && point.tangent.w != 0.0F) {
    normal = normal_mapped(shader, material, point);
  }
  surface.geometric_normal = surface.front ? point.geometric_normal : -point.geometric_normal;
  // Meshes exist whose normals contradict their winding; the winding says which side is outside.
  const bool agree = glm::dot(normal, point.geometric_normal) >= 0.0F;
  surface.normal = agree == surface.front ? normal : -normal;

  glm::vec4 colour = material.base_colour * point.colour;
  if (material.base_colour_texture != scenes::kNone) {
    colour *= sample(shader.textures[material.base_colour_texture], point.uv, point.footprint);
  }
  surface.base_colour = glm::vec3(colour);
  surface.alpha = resolve_alpha(material, colour.w);

  surface.metallic = material.metallic;
  surface.roughness = material.roughness;
  if (material.metallic_roughness_texture != scenes::kNone) {
    const glm::vec4 texel =
        sample(shader.textures[material.metallic_roughness_texture], point.uv, point.footprint);
    surface.roughness *= texel.y;
    surface.metallic *= texel.z;
  }
  surface.transmission = material.transmission;
  surface.ior = material.ior;
  surface.emission = material.emission;
  if (material.emission_texture != scenes::kNone) {
    surface.emission *=
        glm::vec3(sample(shader.textures[material.emission_texture], point.uv, point.footprint));
  }
  return surface;
}

float coverage(const Shader& shader, const scenes::Material& material, const glm::vec2& uv,
               const Footprint& footprint, float vertex_alpha) {
  if (material.alpha == Alpha::opaque) return 1.0F;
  float alpha = material.base_colour.w * vertex_alpha;
  if (material.base_colour_texture != scenes::kNone) {
    alpha *= sample_alpha(shader.textures[material.base_colour_texture], uv, footprint);
  }
  return resolve_alpha(material, alpha);
}

}  // namespace delray::shading
