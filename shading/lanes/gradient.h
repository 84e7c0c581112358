// How much of its three colours an environment without a texture sends.
#pragma once

#include <algorithm>
#include <cmath>

namespace delray::shading {

struct GradientWeights {
  float horizon, zenith, ground;
};

// From the direction whose cosine with `up` is `height`.
inline GradientWeights sharp_weights(float height) {
  const float t = std::min(std::abs(height), 1.0F);
  const bool above = height >= 0.0F;
  return {1.0F - t, above ? t : 0.0F, above ? 0.0F : t};
}

// The polynomial of diffuse_weights, coefficients of rising powers.
inline constexpr float kLens[5] = {0.212206316F, -0.0150095516F, 0.00387253269F, -0.00126495469F,
                                   0.000266124402F};

// On average over the hemisphere around the direction at `height`, weighted with the cosine.
//
// The integral of two clamped cosines whose axes are `angle` apart, over pi, is
// 2 (sin angle + (pi - angle) cos angle) / (3 pi). Where the axes are more than a right angle apart
// it is (1 - x)^(3/2) times a smooth function of x = |cos angle|, of which this is a Chebyshev
// interpolant (error of the whole: 4e-7); for the opposite axis 2 x / 3 comes on top.
inline GradientWeights diffuse_weights(float height) {
  const float x = std::min(std::abs(height), 1.0F);
  const float rest = 1.0F - x;
  const float lens = kLens[0] + x * (kLens[1] + x * (kLens[2] + x * (kLens[3] + x * kLens[4])));
  const float far = rest * std::sqrt(rest) * lens;
  const float near = far + x * (2.0F / 3.0F);
  const bool above = height >= 0.0F;
  return {1.0F - (near + far), above ? near : far, above ? far : near};
}

// a at t = 0, b at t = 1.
inline GradientWeights between(const GradientWeights& a, const GradientWeights& b, float t) {
  return {a.horizon + (b.horizon - a.horizon) * t, a.zenith + (b.zenith - a.zenith) * t,
          a.ground + (b.ground - a.ground) * t};
}

}  // namespace delray::shading
