// Looks up a material's textures at a point and multiplies its factors by them (glTF 2.0 and its
// extensions for coats, sheens, transmission, volumes and specular colours).
//
// Degenerate: a normal map that gives the zero vector leaves the interpolated normal; a mesh
// without tangents ignores normal maps; a surface that transmits light but has no thickness is seen
// from its front on both sides.
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
  const glm::vec4 texel = sample(shader.textures[material.normal_texture], point);
  const float x = (2.0F * texel.x - 1.0F) * material.normal_scale;
  const float y = (2.0F * texel.y - 1.0F) * material.normal_scale;
  const float z = 2.0F * texel.z - 1.0F;
  const glm::vec3 mapped = tangent * x + bitangent * y + point.normal * z;
  const float squared = glm::dot(mapped, mapped);
  return squared > 0.0F ? mapped * (1.0F / std::sqrt(squared)) : point.normal;
}

glm::vec4 looked_up(const Shader& shader, std::uint32_t texture, const Point& point) {
  if (texture == scenes::kNone) return glm::vec4(1.0F);
  return sample(shader.textures[texture], point);
}

// On the viewer's side. Meshes exist whose normals contradict their winding; the winding says which
// side is outside.
glm::vec3 turned(const glm::vec3& normal, const Point& point, bool front) {
  const bool agree = glm::dot(normal, point.geometric_normal) >= 0.0F;
  return agree == front ? normal : -normal;
}

}  // namespace

bool is_layered(const scenes::Material& material) {
  return material.clearcoat > 0.0F || material.sheen_colour != glm::vec3(0.0F);
}

void evaluate_layers(const Shader& shader, const scenes::Material& material, const Point& point,
                     Surface& surface) {
  surface.clearcoat = material.clearcoat * looked_up(shader, material.clearcoat_texture, point).x;
  surface.clearcoat_roughness = material.clearcoat_roughness *
                                looked_up(shader, material.clearcoat_roughness_texture, point).y;
  surface.coat_normal = turned(point.normal, point, surface.front);
  surface.sheen_colour =
      material.sheen_colour * glm::vec3(looked_up(shader, material.sheen_colour_texture, point));
  surface.sheen_roughness =
      material.sheen_roughness * looked_up(shader, material.sheen_roughness_texture, point).w;
}

glm::vec3 transmittance(const scenes::Material& material, float distance) {
  const float ways = distance / material.attenuation_distance;
  if (!(ways > 0.0F)) return glm::vec3(1.0F);
  const glm::vec3& colour = material.attenuation_colour;
  return {exp2(ways * log2(colour.x)), exp2(ways * log2(colour.y)), exp2(ways * log2(colour.z))};
}

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
  surface.normal = turned(normal, point, surface.front);
  if (is_layered(material)) evaluate_layers(shader, material, point, surface);

  glm::vec4 colour = material.base_colour * point.colour;
  if (material.base_colour_texture != scenes::kNone) {
    colour *= sample(shader.textures[material.base_colour_texture], point);
  }
  surface.base_colour = glm::vec3(colour);
  surface.alpha = resolve_alpha(material, colour.w);

  surface.metallic = material.metallic;
  surface.roughness = material.roughness;
  if (material.metallic_roughness_texture != scenes::kNone) {
    const glm::vec4 texel = sample(shader.textures[material.metallic_roughness_texture], point);
    surface.roughness *= texel.y;
    surface.metallic *= texel.z;
  }
  surface.transmission = material.transmission;
  if (material.transmission_texture != scenes::kNone) {
    surface.transmission *= looked_up(shader, material.transmission_texture, point).x;
  }
  surface.ior = material.ior;
  surface.specular = material.specular;
  surface.specular_colour = material.specular_colour;
  if (has_specular_texture(material)) {
    surface.specular *= looked_up(shader, material.specular_texture, point).w;
    surface.specular_colour *=
        glm::vec3(looked_up(shader, material.specular_colour_texture, point));
  }
  if (material.transmission > 0.0F) {
    if (material.thickness > 0.0F) {
      if (surface.front) surface.attenuation = transmittance(material, material.thickness);
    } else {
      surface.front = true;
    }
  }
  surface.emission = material.emission;
  if (material.emission_texture != scenes::kNone) {
    surface.emission *= glm::vec3(sample(shader.textures[material.emission_texture], point));
  }
  surface.unlit = material.unlit;
  if (material.unlit) {
    surface.emission = surface.base_colour;
    surface.base_colour = glm::vec3(0.0F);
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

float coverage(const Shader& shader, const scenes::Material& material, const Point& point) {
  const std::uint32_t texture = material.base_colour_texture;
  const bool second = texture != scenes::kNone && shader.textures[texture].set != 0;
  return coverage(shader, material, second ? point.second.uv : point.uv,
                  second ? point.second.footprint : point.footprint, point.colour.w);
}

}  // namespace delray::shading
