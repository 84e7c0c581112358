// raytrace/sampling/warp.h over lanes. Compiled once per instruction set.
#if defined(DELRAY_RAYTRACE_WARP_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef DELRAY_RAYTRACE_WARP_LANES
#undef DELRAY_RAYTRACE_WARP_LANES
#else
#define DELRAY_RAYTRACE_WARP_LANES
#endif

#include "shading/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace delray::raytrace {
namespace HWY_NAMESPACE {

using namespace shading::HWY_NAMESPACE;

HWY_INLINE F3 cosine_direction(F u, F v) {
  const F x = set(2.0F) * u - set(1.0F), y = set(2.0F) * v - set(1.0F);
  const F zero = set(0.0F);
  const M wide = hn::Gt(hn::Abs(x), hn::Abs(y));
  const F radius = hn::IfThenElse(wide, x, y);
  const F ratio = hn::IfThenElse(wide, y, x) / radius;
  const SinCosLanes angle =
      sin_cos(set(0.25F * shading::kPi) * hn::IfThenZeroElse(hn::Eq(radius, zero), ratio));
  const F disc_x = radius * hn::IfThenElse(wide, angle.cos, angle.sin);
  const F disc_y = radius * hn::IfThenElse(wide, angle.sin, angle.cos);
  const F left = set(1.0F) - disc_x * disc_x - disc_y * disc_y;
  return {disc_x, disc_y, hn::Sqrt(max_of(zero, left))};
}

struct FrameLanes {
  F3 x, y, z;

  HWY_INLINE F3 to_world(const F3& v) const { return x * v.x + y * v.y + z * v.z; }
  HWY_INLINE F3 to_local(const F3& v) const { return {dot(x, v), dot(y, v), dot(z, v)}; }
};

HWY_INLINE FrameLanes frame_around(const F3& normal) {
  const F one = set(1.0F), sign = hn::CopySign(one, normal.z);
  const F a = set(-1.0F) / (sign + normal.z), b = normal.x * normal.y * a;
  return {{one + sign * normal.x * normal.x * a, sign * b, hn::Neg(sign * normal.x)},
          {b, sign + normal.y * normal.y * a, hn::Neg(normal.y)},
          normal};
}

HWY_INLINE F power_heuristic(F a, F b) {
  const F ratio = b / a;
  return set(1.0F) / (set(1.0F) + ratio * ratio);
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raytrace
HWY_AFTER_NAMESPACE();

#endif
