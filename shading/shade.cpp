#include "shading/shade.h"

namespace delray::shading {
namespace {

float facing(const Surface& surface, const glm::vec3& view) {
  return clamp01(glm::dot(surface.normal, view));
}

}  // namespace

glm::vec3 ambient_diffuse(const Shader& shader, const Surface& surface, const Lobes& lobes,
                          const glm::vec3& view) {
  if (shader.environment.black) return glm::vec3(0.0F);
  const glm::vec3 mirrored = specular_albedo(lobes, facing(surface, view));
  return lobes.diffuse * (glm::vec3(1.0F) - mirrored) *
         diffuse_radiance(shader.environment, surface.normal);
}

glm::vec3 ambient_specular(const Shader& shader, const Surface& surface, const Lobes& lobes,
                           const glm::vec3& view) {
  if (shader.environment.black) return glm::vec3(0.0F);
  const float cosine = glm::dot(surface.normal, view);
  const glm::vec3 mirrored = surface.normal * (2.0F * cosine) - view;
  return specular_albedo(lobes, clamp01(cosine)) *
         radiance(shader.environment, shader.textures, mirrored, lobes.roughness);
}

glm::vec3 ambient_transmitted(const Shader& shader, const Surface& surface, const Lobes& lobes,
                              const glm::vec3& view) {
  const float share = clamp01(surface.transmission) * (1.0F - clamp01(surface.metallic));
  if (share <= 0.0F || shader.environment.black) return glm::vec3(0.0F);
  const glm::vec3 through = glm::vec3(1.0F) - specular_albedo(lobes, facing(surface, view));
  return surface.base_colour * through * share *
         radiance(shader.environment, shader.textures, -view, lobes.roughness);
}

}  // namespace delray::shading
