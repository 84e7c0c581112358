// How a surface reflects light: glTF's metallic-roughness model (glTF 2.0, appendix B), a
// Lambertian lobe under a GGX one (Walter et al. 2007) with Smith's height-correlated shadowing
// (Heitz 2014) and Schlick's Fresnel term.
//
// What enters the diffuse layer is what the specular one lets through, on the way in and on the way
// out (Shirley et al. 1997): glTF's own weight, Fresnel's term at the half vector, would give back
// up to 1.3 times the light that arrives.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "shading/arithmetic.h"
#include "shading/surface.h"

namespace delray::shading {

// Below this roughness a highlight of a light without size would fall between the pixels.
inline constexpr float kMinRoughness = 0.08F;

// A viewer lower than this cosine over the horizon counts as being there; the squared length of the
// sum of two directions counts as at least the other.
inline constexpr float kLeastCosine = 1e-4F;
inline constexpr float kLeastSum = 1e-6F;

struct Lobes {
  glm::vec3 diffuse{0.0F};   // albedo
  glm::vec3 entering{1.0F};  // makes the albedo what it says: 1 over the mean of 1 - Fresnel's term
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
  const glm::vec3 mean =
      result.specular + (glm::vec3(result.grazing) - result.specular) * (1.0F / 21.0F);
  result.entering = glm::vec3(1.0F) / glm::max(glm::vec3(1.0F) - mean, glm::vec3(1e-3F));
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
  const float n_v = std::max(glm::dot(normal, view), kLeastCosine);
  const glm::vec3 sum = view + light;
  // Both directions make the same angle with their half vector; its cosine is half the length of
  // their sum.
  const float length2 = std::max(glm::dot(sum, sum), kLeastSum);
  const float v_h = std::min(0.5F * std::sqrt(length2), 1.0F);
  const float along = std::max(glm::dot(normal, sum), 0.0F);
  const float along2 = std::min(along * along, length2);
  // The distribution is a2 / (pi (n_h^2 (a2 - 1) + 1)^2) with n_h^2 = along2 / length2; so written
  // it keeps its digits at the peak, and needs no division of its own.
  const float a2 = lobes.alpha * lobes.alpha;
  const float spread = (length2 - along2) + along2 * a2;
  const float shadowing =
      n_l * std::sqrt(n_v * n_v * (1.0F - a2) + a2) + n_v * std::sqrt(n_l * n_l * (1.0F - a2) + a2);
  const float peak = a2 * (0.5F * kInversePi) * (length2 * length2) / (spread * spread * shadowing);
  const glm::vec3 specular = fresnel(lobes, v_h) * peak;
  const glm::vec3 in = glm::vec3(1.0F) - fresnel(lobes, std::min(n_l, 1.0F));
  const glm::vec3 out = glm::vec3(1.0F) - fresnel(lobes, std::min(n_v, 1.0F));
  const glm::vec3 diffuse = lobes.diffuse * (lobes.entering * kInversePi) * (in * out);
  return (diffuse + specular) * n_l;
}

// The fraction of light from everywhere that the specular lobe reflects to a viewer at the given
// cosine, 0 to 1, interpolated in a table that the first call computes (within 0.03; Karis 2013).
glm::vec3 specular_albedo(const Lobes& lobes, float cosine);

}  // namespace delray::shading
