// shading/lighting.h over lanes. Compiled once per instruction set.
#if defined(DELRAY_SHADING_LIGHTING_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef DELRAY_SHADING_LIGHTING_LANES
#undef DELRAY_SHADING_LIGHTING_LANES
#else
#define DELRAY_SHADING_LIGHTING_LANES
#endif

#include <limits>

#include "shading/batch_shader.h"
#include "shading/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace delray::shading {
namespace HWY_NAMESPACE {

struct IncidentLanes {
  F3 direction;
  F distance;
  F3 irradiance;
  M arrives;  // elsewhere the other members mean nothing
};

// REQUIRES: the light is not dark.
HWY_INLINE IncidentLanes incident(const BatchLight& light, const F3& position) {
  const FloatTag d;
  if (light.kind == scenes::Light::Kind::directional) {
    return {set(light.direction), set(std::numeric_limits<float>::infinity()), set(light.colour),
            hn::FirstN(d, hn::Lanes(d))};
  }
  const F3 way = set(light.source) - position;
  const F distance2 = dot(way, way);
  const F distance = hn::Sqrt(distance2);
  const F3 direction = way * (set(1.0F) / distance);
  const M arrives = hn::Gt(distance2, set(0.0F));
  if (light.kind == scenes::Light::Kind::point) {
    return {direction, distance, set(light.colour) * (set(1.0F) / distance2), arrives};
  }
  const F facing = hn::Neg(dot(set(light.normal), direction));
  return {direction, distance, set(light.colour) * (facing / (distance2 + set(light.area_over_pi))),
          hn::And(arrives, hn::Gt(facing, set(0.0F)))};
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::shading
HWY_AFTER_NAMESPACE();

#endif
