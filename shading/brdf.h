// How a surface reflects light: glTF's metallic-roughness model (glTF 2.0, appendix B), a
// Lambertian lobe under a GGX one (Walter et al. 2007) with Smith's height-correlated shadowing
// (Heitz 2014) and Schlick's Fresnel term.
//
// Light that meets a rough surface more than once is not lost: the specular lobe is scaled by what
// a table says that one meeting leaves out (Kulla and Conty 2017 for how much of which colour,
// Turquin 2019 for scaling the lobe instead of adding another). What the specular lobe does not
// reflect towards the viewer enters the diffuse layer (Turquin's and glTF's albedo scaling). Both
// depend on the viewer alone: white surfaces reflect all of the light from everywhere, but the
// model is reciprocal only where a single meeting is all there is.
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

// A reflectance that is divided by counts as at least this.
inline constexpr float kLeastReflectance = 1e-20F;

// How a surface reflects at one point.
struct Lobes {
  glm::vec3 diffuse{0.0F};   // albedo
  glm::vec3 specular{0.0F};  // reflectance at normal incidence
  float grazing = 1.0F;      // reflectance at grazing incidence
  float alpha = 0.36F;       // GGX width: roughness squared
  float roughness = 0.6F;    // as given, 0 to 1
  // The specular lobe is that of a dielectric and that of a metal, mixed; each at normal and at
  // grazing incidence.
  float metallic = 0.0F;
  glm::vec3 dielectric{0.0F}, metal{0.0F};
  float dielectric_grazing = 1.0F, metal_grazing = 1.0F;
  // What of the light that would leave a white surface of theirs after a second or later meeting
  // leaves them, over what of the first meeting's does.
  glm::vec3 dielectric_again{0.0F}, metal_again{0.0F};
};

// What hardly reflects at all head-on does not do so at grazing angles either: black paint in
// crevices, and glass in a liquid of its own density.
inline float grazing_of(const glm::vec3& reflectance) {
  return std::min(50.0F * std::max(std::max(reflectance.x, reflectance.y), reflectance.z), 1.0F);
}

// Head-on, of the layer that lies over the diffuse one.
inline glm::vec3 dielectric_of(const Surface& surface) {
  const float ratio = (surface.ior - 1.0F) / (surface.ior + 1.0F);
  return glm::min(surface.specular_colour * (ratio * ratio), glm::vec3(1.0F)) * surface.specular;
}

Lobes lobes(const Surface& surface);

// Schlick's approximation at an angle with the given cosine, 0 to 1.
inline glm::vec3 fresnel(const Lobes& lobes, float cosine) {
  return lobes.specular + (glm::vec3(lobes.grazing) - lobes.specular) * pow5(1.0F - cosine);
}

// What depends on the viewer alone.
struct Response {
  glm::vec3 specular{0.0F};  // fraction of light from everywhere that the specular lobe reflects
  glm::vec3 scale{1.0F};     // of the lobe, for light that meets the surface more than once
  float entering = 1.0F;     // fraction that reaches the diffuse layer, or what is behind glass
};

// At a cosine between normal and viewer from 0 to 1, by a table that the first call computes.
Response response(const Lobes& lobes, float cosine);

// The GGX distribution times shadowing over 4 n_l n_v, for cosines n_l > 0 and n_v > 0 with the
// normal, where `sum` is the sum of the directions to both and `along` its part along the normal.
// Directions make the same angle with their half vector; its cosine is half the length of `sum`.
struct Peak {
  float value, v_h;
};

inline Peak ggx_peak(float alpha, float n_l, float n_v, const glm::vec3& sum, float along) {
  const float length2 = std::max(glm::dot(sum, sum), kLeastSum);
  const float along2 = std::min(along * along, length2);
  // The distribution is a2 / (pi (n_h^2 (a2 - 1) + 1)^2) with n_h^2 = along2 / length2; so written
  // it keeps its digits at the peak, and needs no division of its own.
  const float a2 = alpha * alpha;
  const float spread = (length2 - along2) + along2 * a2;
  const float shadowing =
      n_l * std::sqrt(n_v * n_v * (1.0F - a2) + a2) + n_v * std::sqrt(n_l * n_l * (1.0F - a2) + a2);
  return {a2 * (0.5F * kInversePi) * (length2 * length2) / (spread * spread * shadowing),
          std::min(0.5F * std::sqrt(length2), 1.0F)};
}

// f(view, light) * max(0, dot(normal, light)): the radiance towards `view` per unit of irradiance
// at normal incidence from `light`. All directions are unit vectors away from the surface. Zero
// when the light is below the horizon of `normal`; a viewer below it counts as just above.
// `response` is that of the viewer.
inline glm::vec3 reflect(const Lobes& lobes, const Response& response, const glm::vec3& normal,
                         const glm::vec3& view, const glm::vec3& light) {
  const float n_l = glm::dot(normal, light);
  if (!(n_l > 0.0F)) return glm::vec3(0.0F);
  const float n_v = std::max(glm::dot(normal, view), kLeastCosine);
  const glm::vec3 sum = view + light;
  const float along = std::max(glm::dot(normal, sum), 0.0F);
  const Peak peak = ggx_peak(lobes.alpha, n_l, n_v, sum, along);
  const glm::vec3 specular = fresnel(lobes, peak.v_h) * response.scale * peak.value;
  const glm::vec3 diffuse = lobes.diffuse * (response.entering * kInversePi);
  return (diffuse + specular) * n_l;
}

inline glm::vec3 reflect(const Lobes& lobes, const glm::vec3& normal, const glm::vec3& view,
                         const glm::vec3& light) {
  return reflect(lobes, response(lobes, clamp01(glm::dot(normal, view))), normal, view, light);
}

}  // namespace delray::shading
