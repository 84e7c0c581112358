// Gradient noise (Perlin 2002) with its derivative, by linear interpolation with quintic weights of
// one linear function for each corner of the cell; gradients come from a hash of the corner. Sine
// and cosine by Taylor series within an eighth of a turn.
#include "scenes/geometry/noise.h"

#include <cmath>

namespace delray::scenes::internal {
namespace {

// Weights of the far corner of a cell, 6 t^5 - 15 t^4 + 10 t^3, and their derivative.
template <class V>
V fade(const V& t) {
  return t * t * t * (t * (t * 6.0F - 15.0F) + 10.0F);
}
template <class V>
V fade_slope(const V& t) {
  return t * t * (t * (t * 30.0F - 60.0F) + 30.0F);
}

// 16 random bits to [-1, 1].
float signed_unit(std::uint64_t bits) {
  return static_cast<float>(bits & 0xFFFF) * (2.0F / 65535.0F) - 1.0F;
}

std::uint64_t corner_hash(std::uint64_t seed, std::int64_t x, std::int64_t y, std::int64_t z) {
  return scatter(seed + static_cast<std::uint64_t>(x) * 0x8DA6B343U +
                 static_cast<std::uint64_t>(y) * 0xD8163841U * 0x10001U +
                 static_cast<std::uint64_t>(z) * 0xCB1AB31FU * 0x100000007U);
}

// A linear function of the offset from a corner.
struct Slope {
  float value;
  glm::vec3 gradient;
};

Slope mix_slopes(const Slope& a, const Slope& b, float weight) {
  return {a.value + (b.value - a.value) * weight, a.gradient + (b.gradient - a.gradient) * weight};
}

}  // namespace

NoiseSample noise(std::uint64_t seed, const glm::vec3& p) {
  const glm::vec3 cell = glm::floor(p), t = p - cell;
  const auto corner = [&](int i, int j, int k) {
    const std::uint64_t h =
        corner_hash(seed, static_cast<std::int64_t>(cell.x) + i,
                    static_cast<std::int64_t>(cell.y) + j, static_cast<std::int64_t>(cell.z) + k);
    const glm::vec3 g(signed_unit(h), signed_unit(h >> 16), signed_unit(h >> 32));
    return Slope{g.x * (t.x - static_cast<float>(i)) + g.y * (t.y - static_cast<float>(j)) +
                     g.z * (t.z - static_cast<float>(k)),
                 g};
  };
  // Interpolation along x, y, z; each adds the derivative of its own weight.
  const glm::vec3 w = fade(t), d = fade_slope(t);
  const auto along = [](const Slope& a, const Slope& b, float weight, float slope, int axis) {
    Slope s = mix_slopes(a, b, weight);
    s.gradient[axis] += (b.value - a.value) * slope;
    return s;
  };
  Slope faces[2];
  for (int k = 0; k < 2; ++k) {
    const Slope low = along(corner(0, 0, k), corner(1, 0, k), w.x, d.x, 0);
    const Slope high = along(corner(0, 1, k), corner(1, 1, k), w.x, d.x, 0);
    faces[k] = along(low, high, w.y, d.y, 1);
  }
  const Slope s = along(faces[0], faces[1], w.z, d.z, 2);
  return {s.value, s.gradient};
}

NoiseSample noise(std::uint64_t seed, const glm::vec2& p) {
  const glm::vec2 cell = glm::floor(p), t = p - cell;
  const auto corner = [&](int i, int j) {
    const std::uint64_t h = corner_hash(seed, static_cast<std::int64_t>(cell.x) + i,
                                        static_cast<std::int64_t>(cell.y) + j, 0);
    const glm::vec3 g(signed_unit(h), signed_unit(h >> 16), 0);
    return Slope{g.x * (t.x - static_cast<float>(i)) + g.y * (t.y - static_cast<float>(j)), g};
  };
  const glm::vec2 w = fade(t), d = fade_slope(t);
  const Slope a = corner(0, 0), b = corner(1, 0), e = corner(0, 1), f = corner(1, 1);
  Slope low = mix_slopes(a, b, w.x), high = mix_slopes(e, f, w.x);
  low.gradient.x += (b.value - a.value) * d.x;
  high.gradient.x += (f.value - e.value) * d.x;
  Slope s = mix_slopes(low, high, w.y);
  s.gradient.y += (high.value - low.value) * d.y;
  return {s.value, s.gradient};
}

glm::dvec2 turn(double turns) {
  turns -= std::floor(turns);
  const double quarters = std::floor(turns * 4 + 0.5);
  // Taylor series up to x^12 and x^13 on |x| <= pi/4: the remainder is below 1e-12.
  const double x = (turns - quarters * 0.25) * 6.283185307179586476925;
  const double s = x * x;
  const double cosine =
      1 - s / 2 * (1 - s / 12 * (1 - s / 30 * (1 - s / 56 * (1 - s / 90 * (1 - s / 132)))));
  const double sine =
      x * (1 - s / 6 * (1 - s / 20 * (1 - s / 42 * (1 - s / 72 * (1 - s / 110 * (1 - s / 156))))));
  switch (static_cast<int>(quarters) & 3) {
    case 0:
      return {cosine, sine};
    case 1:
      return {-sine, cosine};
    case 2:
      return {-cosine, -sine};
    default:
      return {sine, -cosine};
  }
}

}  // namespace delray::scenes::internal
