#include "raytrace/whitted.h"

#include <algorithm>
#include <bit>

#include "raytrace/internal/ask.h"
#include "raytrace/internal/lane_sums.h"
#include "raytrace/internal/lit_walk.h"
#include "raytrace/optics.h"
#include "shading/shade.h"

namespace delray::raytrace {
namespace {

using shading::LaneMask;

// Roughness up to which a surface is a perfect mirror, and from which it is none.
constexpr float kMirror = 0.15F, kMatt = 0.5F;

class Whitted final : public LitWalk {
 public:
  using LitWalk::LitWalk;

 private:
  LaneMask shade(RayGroup& group, RayLanes& lanes, shading::Shaded& shown) override {
    const LaneMask seen = look_at(group, lanes, surfaces_);
    if (seen == 0) return 0;
    shading::Vectors16 &sum = shown.colour, &colour = colour_;
    copy_lanes(surfaces_.emission, seen, sum);
    shading::ambient_diffuse(setting_.shader, surfaces_, group.view, seen, colour);
    add_lanes(colour, seen, sum);
    ask_lights(group, lanes, seen, surfaces_);

    // How much of the blurred reflection of the environment each lane shows.
    shading::Floats16 blurred;
    LaneMask some = 0, ended = 0;
    for (LaneMask rest = seen; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      if (depth_of(lanes, i) <= 0) {
        ended |= 1U << i;
        blurred[i] = 1.0F;
      } else {
        blurred[i] = ask_around(group, lanes, i);
      }
      some |= blurred[i] > 0.0F ? 1U << i : 0U;
    }
    if (some != 0) {
      shading::ambient_specular(setting_.shader, surfaces_, group.view, some, colour);
      for (int i = 0; i < kPacketRays; ++i) {
        colour.x[i] *= blurred[i];
        colour.y[i] *= blurred[i];
        colour.z[i] *= blurred[i];
      }
      add_lanes(colour, some, sum);
    }
    if (ended != 0) {
      shading::ambient_transmitted(setting_.shader, surfaces_, group.view, ended, colour);
      add_lanes(colour, ended, sum);
    }
    return seen;
  }

  // Asks for the mirrored and the refracted ray of a lane. Returns the part of the reflection that
  // neither of them sees.
  float ask_around(const RayGroup& group, const RayLanes& lanes, int i) {
    const shading::Surface s = shading::surface_at(surfaces_, i);
    const float glass = shading::clamp01(s.transmission) * (1.0F - shading::clamp01(s.metallic));
    // Inside glass there is no environment to stand in for a reflection.
    const bool inside = glass > 0.0F && !s.front;
    const float roughness = surfaces_.lobe_roughness[i];
    const float mirror =
        inside ? 1.0F : shading::clamp01((kMatt - roughness) * (1.0F / (kMatt - kMirror)));
    if (mirror == 0.0F && glass == 0.0F) return 1.0F;
    const glm::vec3 view = group.view.get(i);
    glm::vec3 reflectance = shading::fresnel(shading::lobes_at(surfaces_, i),
                                             shading::clamp01(glm::dot(s.normal, view)));
    Refraction refraction;
    if (glass > 0.0F) {
      refraction = refracted(view, s.normal, s.front ? 1.0F / s.ior : s.ior);
      reflectance += (glm::vec3(refraction.reflected) - reflectance) * glass;
    }
    NextRay ray;
    ray.spread = setting_.view.spread();
    ray.width = group.width[i] + group.packet.far[i] * group.spread[i];
    ray.pixel = lanes.pixel_of(i);
    ray.depth = depth_of(lanes, i) - 1;
    const glm::vec3 weight = lanes.weight_of(i);
    float blurred = inside ? 0.0F : 1.0F;
    ray.weight = weight * reflectance * mirror;
    if (brightest(ray.weight) >= kLeastWeight) {
      blurred = inside ? 0.0F : 1.0F - mirror;
      ray.origin = s.position + s.geometric_normal * group.offset[i];
      ray.direction = kept_on_side(mirrored(view, s.normal), s.geometric_normal);
      ray.view = -ray.direction;
      ask(ray, Bundle::mirrored);
    }
    if (glass > 0.0F && refraction.reflected < 1.0F) {
      ray.weight = weight * s.base_colour * (glass * (1.0F - refraction.reflected));
      if (brightest(ray.weight) >= kLeastWeight) {
        ray.origin = s.position - s.geometric_normal * group.offset[i];
        ray.direction = kept_on_side(refraction.direction, -s.geometric_normal);
        ray.view = -ray.direction;
        ask(ray, Bundle::refracted);
      }
    }
    return blurred;
  }

  shading::Surfaces surfaces_;
  shading::Vectors16 colour_;
};

}  // namespace

std::unique_ptr<Walk> make_whitted(const Setting& setting) {
  return std::make_unique<Whitted>(setting);
}

}  // namespace delray::raytrace
