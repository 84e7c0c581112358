// Terms of local lighting at one point that the header does not have inline: the response to a
// viewer, and light from the environment that is reflected diffusely, mirrored, mirrored by the
// coat, or let through.
#include "shading/shade.h"

namespace delray::shading {

Seen seen_from(const Surface& surface, const glm::vec3& view) {
  Seen seen{view, lobes(surface), layers(surface, view), {}};
  seen.response = response(seen.lobes, clamp01(glm::dot(surface.normal, view)));
  darken(seen.layers, seen.response);
  return seen;
}

glm::vec3 ambient_diffuse(const Shader& shader, const Surface& surface, const Seen& seen) {
  if (shader.environment.black) return glm::vec3(0.0F);
  const glm::vec3 albedo = seen.lobes.diffuse * seen.response.entering + seen.layers.sheen_albedo;
  return albedo * diffuse_radiance(shader.environment, surface.normal);
}

glm::vec3 ambient_specular(const Shader& shader, const Surface& surface, const Seen& seen) {
  if (shader.environment.black) return glm::vec3(0.0F);
  const glm::vec3 mirrored =
      surface.normal * (2.0F * glm::dot(surface.normal, seen.view)) - seen.view;
  return seen.response.specular *
         radiance(shader.environment, shader.textures, mirrored, seen.lobes.roughness);
}

glm::vec3 ambient_coat(const Shader& shader, const Seen& seen) {
  const Layers& layers = seen.layers;
  if (!(layers.coat_albedo > 0.0F) || shader.environment.black) return glm::vec3(0.0F);
  const glm::vec3 mirrored =
      layers.coat_normal * (2.0F * glm::dot(layers.coat_normal, seen.view)) - seen.view;
  return radiance(shader.environment, shader.textures, mirrored, layers.coat_roughness) *
         layers.coat_albedo;
}

glm::vec3 ambient_transmitted(const Shader& shader, const Surface& surface, const Seen& seen) {
  const float share = clamp01(surface.transmission) * (1.0F - clamp01(surface.metallic));
  if (share <= 0.0F || shader.environment.black) return glm::vec3(0.0F);
  return surface.base_colour * surface.attenuation * seen.response.entering * share *
         radiance(shader.environment, shader.textures, -seen.view, seen.lobes.roughness);
}

}  // namespace delray::shading
