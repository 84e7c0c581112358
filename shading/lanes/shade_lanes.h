// shading/shade.h over lanes. Compiled once per instruction set.
#if defined(DELRAY_SHADING_SHADE_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef DELRAY_SHADING_SHADE_LANES
#undef DELRAY_SHADING_SHADE_LANES
#else
#define DELRAY_SHADING_SHADE_LANES
#endif

#include "shading/batch_shader.h"
#include "shading/lanes/brdf_lanes.h"
#include "shading/lanes/environment_lanes.h"
#include "shading/lanes/lighting_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace delray::shading {
namespace HWY_NAMESPACE {

// `mirrored` is Response::specular.
template <class Reflectance>
HWY_INLINE F3 ambient_specular(const Shader& shader, F roughness, const Reflectance& mirrored,
                               const F3& normal, const F3& view, F cosine, M active) {
  const F3 direction = normal * (set(2.0F) * cosine) - view;
  return times(radiance(shader.environment, shader.textures, direction, roughness, active),
               mirrored);
}

// `tint` is base colour times attenuation, `share` what of the light that enters goes through.
HWY_INLINE F3 ambient_transmitted(const Shader& shader, F roughness, F entering, const F3& tint,
                                  F share, const F3& view, M active) {
  const F3 through = tint * entering * share;
  const F3 behind = radiance(shader.environment, shader.textures, negated(view), roughness, active);
  return where(hn::Gt(share, set(0.0F)), through * behind);
}

HWY_INLINE F transmitted_share(F transmission, F metallic) {
  return clamp01(transmission) * (set(1.0F) - clamp01(metallic));
}

// Base colour times attenuation.
HWY_INLINE F3 tint_of(const BatchMaterial& material, const F3& base_colour, M front) {
  return choose(front, base_colour * set(material.attenuation), base_colour);
}

struct ReflectedLanes {
  IncidentLanes light;
  F3 reflected;
  M matters;
};

// REQUIRES: the light is not dark.
template <class Reflectance>
HWY_INLINE ReflectedLanes reflected(const BatchLight& light, const LobeLanes<Reflectance>& lobes,
                                    const F3& position, const F3& normal, const F3& view) {
  const IncidentLanes arriving = incident(light, position);
  const F3 all = reflect(lobes, normal, view, arriving.direction) * arriving.irradiance;
  return {arriving, all, hn::And(arriving.arrives, any_positive(all))};
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::shading
HWY_AFTER_NAMESPACE();

#endif
