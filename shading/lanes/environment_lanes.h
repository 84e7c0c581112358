// shading/environment.h over lanes. Compiled once per instruction set.
#if defined(DELRAY_SHADING_ENVIRONMENT_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef DELRAY_SHADING_ENVIRONMENT_LANES
#undef DELRAY_SHADING_ENVIRONMENT_LANES
#else
#define DELRAY_SHADING_ENVIRONMENT_LANES
#endif

#include <algorithm>

#include "shading/environment.h"
#include "shading/lanes.h"
#include "shading/lanes/gradient.h"
#include "shading/lanes/texture_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace delray::shading {
namespace HWY_NAMESPACE {

struct GradientLanes {
  F horizon, zenith, ground;
};

HWY_INLINE GradientLanes sharp_weights(F height) {
  const F t = min_of(hn::Abs(height), set(1.0F));
  const M above = hn::Ge(height, set(0.0F));
  return {set(1.0F) - t, hn::IfThenElseZero(above, t), hn::IfThenZeroElse(above, t)};
}

HWY_INLINE GradientLanes diffuse_weights(F height) {
  const F x = min_of(hn::Abs(height), set(1.0F));
  const F rest = set(1.0F) - x;
  const F lens =
      set(kLens[0]) +
      x * (set(kLens[1]) + x * (set(kLens[2]) + x * (set(kLens[3]) + x * set(kLens[4]))));
  const F far = rest * hn::Sqrt(rest) * lens;
  const F near = far + x * set(2.0F / 3.0F);
  const M above = hn::Ge(height, set(0.0F));
  return {set(1.0F) - (near + far), hn::IfThenElse(above, near, far),
          hn::IfThenElse(above, far, near)};
}

HWY_INLINE F3 gradient(const Environment& e, const GradientLanes& w) {
  return set(e.horizon) * w.horizon + set(e.zenith) * w.zenith + set(e.ground) * w.ground;
}

HWY_INLINE F3 harmonic_radiance(const Environment& e, const F3& d) {
  const F c = set(1.09254843F), one = set(0.488602512F);
  const F weights[9] = {set(0.282094792F),
                        one * d.y,
                        one * d.z,
                        one * d.x,
                        c * d.x * d.y,
                        c * d.y * d.z,
                        set(0.315391565F) * (set(3.0F) * d.z * d.z - set(1.0F)),
                        c * d.x * d.z,
                        set(0.546274215F) * (d.x * d.x - d.y * d.y)};
  F3 sum = set(glm::vec3(0.0F));
  for (int i = 0; i < 9; ++i) sum = sum + set(e.harmonics[i]) * weights[i];
  const F zero = set(0.0F);
  return {max_of(sum.x, zero), max_of(sum.y, zero), max_of(sum.z, zero)};
}

// REQUIRES: the environment is not black.
HWY_INLINE F3 diffuse_radiance(const Environment& e, const F3& normal) {
  if (e.texture != scenes::kNone) return harmonic_radiance(e, normal);
  return gradient(e, diffuse_weights(dot(normal, set(e.up))));
}

// Kept out of line: large, and not on the way of scenes under a plain sky.
inline HWY_NOINLINE F3 textured_radiance(const Environment& e, const Texture& texture,
                                         const F3& direction, F roughness, M active) {
  const F u =
      atan2(dot(direction, set(e.right)), dot(direction, set(e.front))) * set(0.5F * kInversePi) +
      set(0.5F);
  const F v = acos(dot(direction, set(e.up))) * set(kInversePi);
  const float roughest = std::max(0.0F, static_cast<float>(texture.levels.size()) - 4.0F);
  const F3 blurred = sample(texture, u, v, roughness * set(roughest), active).colour;
  const M rough = hn::Gt(roughness, set(0.5F));
  if (hn::AllFalse(FloatTag(), rough)) return blurred;
  const F3 rougher =
      mix(blurred, harmonic_radiance(e, direction), set(2.0F) * roughness - set(1.0F));
  return choose(rough, rougher, blurred);
}

// REQUIRES: the environment is not black.
HWY_INLINE F3 radiance(const Environment& e, std::span<const Texture> textures, const F3& direction,
                       F roughness, M active) {
  if (e.texture != scenes::kNone) {
    return textured_radiance(e, textures[e.texture], direction, roughness, active);
  }
  const F height = dot(direction, set(e.up));
  const GradientLanes a = sharp_weights(height), b = diffuse_weights(height);
  return gradient(e, {mix(a.horizon, b.horizon, roughness), mix(a.zenith, b.zenith, roughness),
                      mix(a.ground, b.ground, roughness)});
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::shading
HWY_AFTER_NAMESPACE();

#endif
