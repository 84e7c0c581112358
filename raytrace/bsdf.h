// How a surface scatters light in all directions: shading::reflect, completed by transmission and
// by a way to draw directions, for integrators that follow light from anywhere.
//
// Three lobes: the diffuse one and the specular one of shading/brdf.h, and light that passes a
// rough interface (Walter et al. 2007). The share of a material that is glass reflects by Fresnel's
// equations, which know total reflection, the rest by Schlick's approximation. Below
// shading::kMinRoughness the interface is smooth: its reflection and refraction are deltas, which
// only `sample` finds. An interface between media of (nearly) the same density lets light straight
// through.
//
// Rays carry radiance over the square of the index of refraction, which refraction leaves as it is;
// so light on both sides of an interface counts alike.
#pragma once

#include <glm/glm.hpp>

#include "raytrace/warp.h"
#include "shading/brdf.h"
#include "shading/surface.h"

namespace delray::raytrace {

// A surface seen from `view`. Directions are unit vectors away from the surface.
struct Bsdf {
  Frame frame;  // its z is the shading normal, turned, if need be, until the viewer is above it
  glm::vec3 geometric_normal{0, 0, 1};
  glm::vec3 view{0, 0, 1};  // in the frame; z > 0
  shading::Lobes lobes;
  glm::vec3 transmitted{0.0F};  // glass times base colour: tints what passes
  float glass = 0.0F;
  float ratio = 1.0F;          // index of refraction on the viewer's side over that of the other
  bool smooth = false;         // reflection, and refraction with it, has one direction only
  bool straight = false;       // what passes does not change direction
  float diffuse_share = 1.0F;  // with which the diffuse lobe is drawn from; the rest: the others
  bool black = false;          // nothing leaves in any direction
};

// `view` is the unit vector to the viewer, for which `surface` was evaluated.
Bsdf make_bsdf(const shading::Surface& surface, const glm::vec3& view);

struct BsdfValue {
  glm::vec3 value{0.0F};  // f(view, light) * |cos|: radiance to the viewer per unit of irradiance
                          // at normal incidence
  float pdf = 0.0F;       // with which `sample` draws the direction, per steradian
};

// Without deltas. Zero for directions whose side of the geometric normal is not that of the shading
// normal: no light leaks through a closed mesh.
BsdfValue evaluate(const Bsdf& bsdf, const glm::vec3& light);

struct BsdfSample {
  glm::vec3 direction{0.0F};  // to where light comes from
  glm::vec3 weight{0.0F};     // f |cos| / pdf; zero: nothing comes of this sample
  float pdf = 0.0F;           // as evaluate gives it; 0 for a delta
  bool delta = false;
  bool transmitted = false;  // to the other side of the surface
};

// `lobe` and both numbers of `u` from [0, 1). The mean of `weight` is the albedo, at most about 1.
// Normals are drawn as the viewer sees them (Heitz 2018, by the spherical caps of Dupuy and Benyoub
// 2023).
BsdfSample sample(const Bsdf& bsdf, float lobe, const glm::vec2& u);

}  // namespace delray::raytrace
