// How a surface reflects light: glTF's metallic-roughness model (glTF 2.0, appendix B), a
// Lambertian lobe under a GGX one (Walter et al. 2007) with Smith's height-correlated shadowing
// (Heitz 2014) and Schlick's Fresnel term.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "shading/arithmetic.h"
#include "shading/surface.h"

namespace delray::shading {

// Below this roughness a highlight of a light without size would fall between the pixels.
inline constexpr float kMinRoughness = 0.08F;

struct Lobes {
  glm::vec3 diffuse{0.0F};   // albedo
  glm::vec3 specular{0.0F};  // reflectance at normal incidence
  float grazing = 1.0F;      // reflectance at grazing incidence
  float alpha = 0.36F;       // GGX width: roughness squared
  float roughness = 0.6F;    // as given, 0 to 1
};

inline Lobes lobes(const Surface& surface) {
  const float metallic = clamp01(surface.metallic);
  const float roughness = clamp01(surface.roughness);
  const float ratio = (surface.ior - 1.0F) / (surface.ior + 1.0F);
  const glm::vec3 dielectric(ratio * ratio);
  Lobes result;
  result.diffuse =
      surface.base_colour * ((1.0F - metallic) * (1.0F - clamp01(surface.transmission)));
  result.specular = dielectric + (surface.base_colour - dielectric) * metallic;
  // What hardly reflects at all head-on does not do so at grazing angles either: black paint in
  // crevices, and glass in a liquid of its own density.
  const float brightest =
      std::max(std::max(result.specular.x, result.specular.y), result.specular.z);
  result.grazing = std::min(50.0F * brightest, 1.0F);
  const float wide = std::max(roughness, kMinRoughness);
  result.alpha = wide * wide;
  result.roughness = roughness;
  return result;
}

// Schlick's approximation at an angle with the given cosine, 0 to 1.
inline glm::vec3 fresnel(const Lobes& lobes, float cosine) {
  return lobes.specular + (glm::vec3(lobes.grazing) - lobes.specular) * pow5(1.0F - cosine);
}

// f(view, light) * max(0, dot(normal, light)): the radiance towards `view` per unit of irradiance
// at normal incidence from `light`. All directions are unit vectors away from the surface. Zero
// when the light is below the horizon of `normal`; a viewer below it counts as just above.
inline glm::vec3 reflect(const Lobes& lobes, const glm::vec3& normal, const glm::vec3& view,
                         const glm::vec3& light) {
  const float n_l = glm::dot(normal, light);
  if (!(n_l > 0.0F)) return glm::vec3(0.0F);
  const float n_v = std::max(glm::dot(normal, view), 1e-4F);
  const glm::vec3 sum = view + light;
  const float length2 = std::max(glm::dot(sum, sum), 1e-12F);
  const float inverse = 1.0F / std::sqrt(length2);
  const float n_h = std::min(std::max(glm::dot(normal, sum) * inverse, 0.0F), 1.0F);
  // Both directions make the same angle with their half vector; its cosine is half the length of
  // sum.
  const float v_h = std::min(0.5F * length2 * inverse, 1.0F);
  const float a2 = lobes.alpha * lobes.alpha;
  const float d = (n_h * a2 - n_h) * n_h + 1.0F;
  const float distribution = a2 / (kPi * d * d);
  const float shadowing =
      n_l * std::sqrt(n_v * n_v * (1.0F - a2) + a2) + n_v * std::sqrt(n_l * n_l * (1.0F - a2) + a2);
  const glm::vec3 f = fresnel(lobes, v_h);
  const glm::vec3 specular = f * (distribution * 0.5F / shadowing);
  const glm::vec3 diffuse = lobes.diffuse * (glm::vec3(1.0F) - f) * kInversePi;
  return (diffuse + specular) * n_l;
}

// The fraction of light from everywhere that the specular lobe reflects to a viewer at the given
// cosine: the fit of Lazarov (2013) in the form of Karis (2014).
inline glm::vec3 specular_albedo(const Lobes& lobes, float cosine) {
  const float r = lobes.roughness;
  const float x = 1.0F - r;
  const float y = 0.0425F - 0.0275F * r;
  const float a = std::min(x * x, exp2(-9.28F * cosine)) * x + y;
  const float scale = -1.04F * a + (1.04F - 0.572F * r);
  const float bias = 1.04F * a + (0.022F * r - 0.04F);
  return glm::min(
      glm::max(lobes.specular * scale + glm::vec3(lobes.grazing * bias), glm::vec3(0.0F)),
      glm::vec3(1.0F));
}

}  // namespace delray::shading
