// The few transcendental functions that shading needs, out of + - * / and comparisons alone, so
// that every machine and every vector width computes the same bits. Errors are absolute unless said
// to be relative; the test measures them.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace delray::shading {

inline constexpr float kPi = 3.14159265358979323846F;
inline constexpr float kInversePi = 0.318309886183790671538F;

// The largest integer <= x. REQUIRES: |x| < 2^31.
inline std::int32_t floor_to_int(float x) {
  const auto i = static_cast<std::int32_t>(x);
  return i - (x < static_cast<float>(i) ? 1 : 0);
}

// NaN gives 0.
inline float clamp01(float x) { return std::min(std::max(0.0F, x), 1.0F); }

inline float mix(float a, float b, float t) { return a + (b - a) * t; }

// Base-2 logarithm: error at most 2e-7 or 2e-7 of the result, whichever is larger. What is below
// the smallest normal number counts as that number: log2(0) = -126. REQUIRES: x >= 0 and finite.
inline float log2(float x) {
  x = std::max(x, 0x1p-126F);
  // The mantissa is taken from [sqrt(1/2), sqrt(2)), so that the series below is short.
  const auto bits = std::bit_cast<std::int32_t>(x);
  const std::int32_t exponent = (bits - 0x3F3504F3) >> 23;
  const float m = std::bit_cast<float>(bits - exponent * (1 << 23));
  const float s = (m - 1.0F) / (m + 1.0F);
  const float s2 = s * s;
  // 2 atanh(s) / (s ln 2), a Chebyshev interpolant for s^2 <= 0.0295.
  const float p = 2.88539008F + s2 * (0.961798839F + s2 * (0.576715186F + s2 * 0.431717697F));
  return static_cast<float>(exponent) + s * p;
}

// 2^x, relative error at most 2e-7; x is clamped to [-126, 127.4]. REQUIRES: x is not NaN.
inline float exp2(float x) {
  x = std::min(std::max(x, -126.0F), 127.4F);
  const std::int32_t n = floor_to_int(x + 0.5F);
  const float r = x - static_cast<float>(n);
  const float p =
      1.0F + r * (0.693147207F +
                  r * (0.240226509F +
                       r * (0.0555032723F +
                            r * (0.00961805668F + r * (0.00134004282F + r * 0.000154614447F)))));
  return p * std::bit_cast<float>((n + 127) << 23);
}

// x^y, relative error at most 3e-7 * (1 + |y log2 x|); 0^y is 0. REQUIRES: x >= 0, y > 0.
inline float pow(float x, float y) { return x <= 0.0F ? 0.0F : exp2(y * log2(x)); }

inline float pow5(float x) {
  const float x2 = x * x;
  return x2 * x2 * x;
}

// The angle of (x, y), in [-pi, pi], error at most 4e-7; 0 for (0, 0).
inline float atan2(float y, float x) {
  const float ax = std::abs(x), ay = std::abs(y);
  const float low = std::min(ax, ay), high = std::max(ax, ay);
  if (high == 0.0F) return 0.0F;
  // atan(t) = pi/4 + atan((t - 1) / (t + 1)) brings t = low / high into |t| <= tan(pi/8).
  const bool upper = low > high * 0.414213562F;
  const float t = upper ? (low - high) / (low + high) : low / high;
  const float t2 = t * t;
  const float p =
      0.999999981F +
      t2 * (-0.333327858F + t2 * (0.199740824F + t2 * (-0.138484902F + t2 * 0.0797629181F)));
  float angle = t * p + (upper ? 0.785398163F : 0.0F);
  if (ay > ax) angle = 1.57079633F - angle;
  if (x < 0.0F) angle = kPi - angle;
  return y < 0.0F ? -angle : angle;
}

// The angle in [0, pi] whose cosine is x, error at most 4e-7; x is clamped to [-1, 1].
inline float acos(float x) {
  x = std::min(std::max(x, -1.0F), 1.0F);
  return atan2(std::sqrt((1.0F - x) * (1.0F + x)), x);
}

// Sine and cosine of one angle.
struct SinCos {
  float sin, cos;
};

// Sine and cosine of x radians, error at most 3e-7 for |x| <= 10.
inline SinCos sin_cos(float x) {
  const std::int32_t quarter = floor_to_int(x * 0.636619772F + 0.5F);
  const auto q = static_cast<float>(quarter);
  // pi/2 in two pieces, of which the first has few enough bits for an exact product.
  const float r = (x - q * 1.5703125F) - q * 4.83826794897e-4F;
  const float r2 = r * r;
  const float s =
      r * (0.999999997F + r2 * (-0.166666507F + r2 * (0.00833203579F + r2 * -0.000195039043F)));
  const float c = 1.0F + r2 * (-0.499999996F +
                               r2 * (0.0416666167F + r2 * (-0.0013886618F + r2 * 2.43798312e-05F)));
  switch (quarter & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

}  // namespace delray::shading
