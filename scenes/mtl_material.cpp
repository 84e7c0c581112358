#include "scenes/internal/mtl_material.h"

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "image/srgb.h"

namespace delray::scenes::internal {
namespace {

std::optional<float> number(const aiMaterial& from, const char* key, unsigned type,
                            unsigned index) {
  float value = 0;
  if (from.Get(key, type, index, value) != aiReturn_SUCCESS || !std::isfinite(value)) return {};
  return value;
}

std::optional<glm::vec3> colour(const aiMaterial& from, const char* key, unsigned type,
                                unsigned index) {
  aiColor3D value;
  if (from.Get(key, type, index, value) != aiReturn_SUCCESS) return {};
  const glm::vec3 c(value.r, value.g, value.b);
  if (!std::isfinite(c.x) || !std::isfinite(c.y) || !std::isfinite(c.z)) return {};
  return glm::max(c, glm::vec3(0));
}

glm::vec3 linear(const glm::vec3& srgb) {
  return {image::decode_srgb_value(srgb.x), image::decode_srgb_value(srgb.y),
          image::decode_srgb_value(srgb.z)};
}

Texture::Wrap wrap_of(aiTextureMapMode mode) {
  if (mode == aiTextureMapMode_Mirror) return Texture::Wrap::mirror;
  return mode == aiTextureMapMode_Wrap ? Texture::Wrap::repeat : Texture::Wrap::clamp;
}

std::uint32_t texture(const aiMaterial& from, aiTextureType type, bool srgb,
                      TextureFiles& textures) {
  aiString path;
  aiTextureMapMode modes[3] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
  const aiReturn found = from.GetTexture(type, 0, &path, nullptr, nullptr, nullptr, nullptr, modes);
  if (found != aiReturn_SUCCESS || path.length == 0) return kNone;
  return textures.from_file(path.C_Str(), {srgb, wrap_of(modes[0]), wrap_of(modes[1])});
}

float roughness_of(const aiMaterial& from) {
  if (const auto given = number(from, AI_MATKEY_ROUGHNESS_FACTOR)) return *given;
  const auto specular = colour(from, AI_MATKEY_COLOR_SPECULAR);
  const auto exponent = number(from, AI_MATKEY_SHININESS);
  if (!exponent || !specular || *specular == glm::vec3(0)) return 0.8F;
  return std::sqrt(std::sqrt(2.0F / (std::max(*exponent, 0.0F) + 2.0F)));
}

}  // namespace

Material mtl_material(const aiMaterial& from, TextureFiles& textures) {
  Material material;
  aiString name;
  if (from.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS) material.name = name.C_Str();
  material.base_colour_texture = texture(from, aiTextureType_DIFFUSE, true, textures);
  material.normal_texture = texture(from, aiTextureType_NORMALS, false, textures);
  material.emission_texture = texture(from, aiTextureType_EMISSIVE, true, textures);

  if (const auto diffuse = colour(from, AI_MATKEY_COLOR_DIFFUSE)) {
    glm::vec3 base = linear(glm::min(*diffuse, glm::vec3(1)));
    // Many files leave Kd black where a texture says the colour.
    if (material.base_colour_texture != kNone && base == glm::vec3(0)) base = glm::vec3(1);
    material.base_colour = glm::vec4(base, 1.0F);
  }
  material.emission = colour(from, AI_MATKEY_COLOR_EMISSIVE).value_or(glm::vec3(0));
  if (material.emission_texture != kNone && material.emission == glm::vec3(0)) {
    material.emission = glm::vec3(1);
  }
  material.roughness = std::clamp(roughness_of(from), 0.0F, 1.0F);
  material.metallic =
      std::clamp(number(from, AI_MATKEY_METALLIC_FACTOR).value_or(0.0F), 0.0F, 1.0F);
  const float opacity = number(from, AI_MATKEY_OPACITY).value_or(1.0F);
  // Exporters that mean Tr when they write d make models vanish: 0 is taken as opaque.
  if (opacity > 0 && opacity < 1) {
    material.base_colour.a = opacity;
    material.alpha = Material::Alpha::blend;
  }
  if (from.GetTextureCount(aiTextureType_OPACITY) > 0 && material.base_colour_texture != kNone) {
    material.alpha =
        Material::Alpha::mask;  // cut-outs, as a rule in the colour texture's alpha too
  }
  const float ior = number(from, AI_MATKEY_REFRACTI).value_or(1.5F);
  if (ior > 1.0F && ior < 4.0F) material.ior = ior;
  return material;
}

}  // namespace delray::scenes::internal
