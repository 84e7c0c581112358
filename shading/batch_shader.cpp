// Computes for each material and each light, once, the parts of shading that do not depend on the
// point: lobes of the factors, rows of the specular table at the material's roughness, whether
// textures or colours of vertices can change the specular lobe, directions of directional lights.
#include "shading/batch_shader.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "shading/lanes/specular_table.h"
#include "shading/lighting.h"

namespace delray::shading {
namespace {

using Specular = BatchMaterial::Specular;

Specular specular_of(const scenes::Material& material, bool colour_varies) {
  if (material.unlit) return Specular::grey;
  if (material.metallic_roughness_texture != scenes::kNone || has_specular_texture(material)) {
    return Specular::varying;
  }
  const glm::vec3& colour = material.specular_colour;
  const bool grey = colour.x == colour.y && colour.y == colour.z;
  if (clamp01(material.metallic) == 0.0F) return grey ? Specular::grey : Specular::coloured;
  return colour_varies ? Specular::varying : Specular::coloured;
}

// A texture that is opaque leaves a factor as it is.
bool covers(const Shader& shader, const scenes::Material& material) {
  if (material.alpha == scenes::Material::Alpha::opaque) return true;
  const std::uint32_t texture = material.base_colour_texture;
  if (texture != scenes::kNone && !shader.textures[texture].opaque) return false;
  scenes::Material plain = material;
  plain.base_colour_texture = scenes::kNone;
  return coverage(shader, plain, glm::vec2(0.0F), {}, 1.0F) == 1.0F;
}

BatchMaterial make_material(const Shader& shader, const scenes::Material& material) {
  BatchMaterial result;
  result.covers = covers(shader, material);
  result.texture_sets = texture_sets(shader, material);
  result.layered = is_layered(material);
  result.material = material;
  result.material.name.clear();
  result.plain = specular_of(material, material.base_colour_texture != scenes::kNone);
  result.coloured = specular_of(material, true);
  Surface surface;
  surface.base_colour = glm::vec3(material.base_colour);
  surface.metallic = material.metallic;
  surface.roughness = material.roughness;
  surface.transmission = material.transmission;
  surface.ior = material.ior;
  surface.unlit = material.unlit;
  surface.specular = material.specular;
  surface.specular_colour = material.specular_colour;
  result.lobes = lobes(surface);
  if (material.transmission > 0.0F && material.thickness > 0.0F) {
    result.absorbs = std::isfinite(material.attenuation_distance);
    result.attenuation = transmittance(material, material.thickness);
  }
  static_assert(SpecularTable::kCosines == kBlockPoints + 1);
  for (int j = 0; j < kBlockPoints; ++j) {
    const SpecularShares low = specular_shares_at(result.lobes.roughness, j);
    const SpecularShares high = specular_shares_at(result.lobes.roughness, j + 1);
    result.normal[j] = low.normal, result.normal_step[j] = high.normal - low.normal;
    result.grazing[j] = low.grazing, result.grazing_step[j] = high.grazing - low.grazing;
  }
  return result;
}

BatchLight make_light(const scenes::Light& light) {
  BatchLight result;
  result.kind = light.kind;
  result.colour = light.colour;
  switch (light.kind) {
    case scenes::Light::Kind::directional: {
      const Incident everywhere = incident(light, glm::vec3(0.0F));
      result.direction = everywhere.direction;
      result.dark = everywhere.irradiance == glm::vec3(0.0F);
      break;
    }
    case scenes::Light::Kind::point:
      result.source = light.position;
      break;
    case scenes::Light::Kind::area:
      result.source = light.position + (light.edge_u + light.edge_v) * 0.5F;
      result.normal = glm::cross(light.edge_u, light.edge_v);
      result.area_over_pi = std::sqrt(glm::dot(result.normal, result.normal)) * kInversePi;
      break;
  }
  return result;
}

}  // namespace

BatchShader make_batch_shader(const Shader& shader, std::span<const scenes::Material> materials) {
  assert(!materials.empty());
  BatchShader result;
  result.shader = &shader;
  result.materials.resize(materials.size());
  std::transform(materials.begin(), materials.end(), result.materials.begin(),
                 [&](const scenes::Material& material) { return make_material(shader, material); });
  result.lights.resize(shader.lights.size());
  std::transform(shader.lights.begin(), shader.lights.end(), result.lights.begin(), make_light);
  return result;
}

}  // namespace delray::shading
