// shading/shade.h over lanes. Compiled once per instruction set.
#if defined(DELRAY_SHADING_SHADE_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef DELRAY_SHADING_SHADE_LANES
#undef DELRAY_SHADING_SHADE_LANES
#else
#define DELRAY_SHADING_SHADE_LANES
#endif

#include "shading/batch_shader.h"
#include "shading/internal/brdf_lanes.h"
#include "shading/internal/environment_lanes.h"
#include "shading/internal/lighting_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace delray::shading {
namespace HWY_NAMESPACE {

// `mirrored` is specular_albedo at the cosine between normal and view.
template <class Reflectance>
HWY_INLINE F3 ambient_diffuse(const Environment& e, const F3& diffuse, const Reflectance& mirrored,
                              const F3& normal) {
  return times(diffuse, one_minus(mirrored)) * diffuse_radiance(e, normal);
}

// `cosine` is that between normal and view, of either sign.
template <class Reflectance>
HWY_INLINE F3 ambient_specular(const Shader& shader, F roughness, const Reflectance& mirrored,
                               const F3& normal, const F3& view, F cosine, M active) {
  const F3 direction = normal * (set(2.0F) * cosine) - view;
  return times(radiance(shader.environment, shader.textures, direction, roughness, active),
               mirrored);
}

// `share` is what of the light that is not mirrored goes through, 0 to 1.
template <class Reflectance>
HWY_INLINE F3 ambient_transmitted(const Shader& shader, F roughness, const Reflectance& mirrored,
                                  const F3& base_colour, F share, const F3& view, M active) {
  const F3 through = times(base_colour, one_minus(mirrored)) * share;
  const F3 behind = radiance(shader.environment, shader.textures, negated(view), roughness, active);
  return where(hn::Gt(share, set(0.0F)), through * behind);
}

struct ReflectedLanes {
  IncidentLanes light;
  F3 reflected;
  M matters;
};

// REQUIRES: the light is not dark.
template <class Reflectance>
HWY_INLINE ReflectedLanes reflected(const BatchLight& light, const LobeLanes<Reflectance>& lobes,
                                    const ViewTerms<Reflectance>& viewer, const F3& position,
                                    const F3& normal, const F3& view) {
  const IncidentLanes arriving = incident(light, position);
  const F3 all = reflect(lobes, viewer, normal, view, arriving.direction) * arriving.irradiance;
  return {arriving, all, hn::And(arriving.arrives, any_positive(all))};
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::shading
HWY_AFTER_NAMESPACE();

#endif
