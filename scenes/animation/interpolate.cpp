// Key frames by bisection: steps, straight lines, arcs of unit quaternions (Shoemake 1985) and
// cubic Hermite splines whose tangents are per second, as glTF 2.0, appendix C, has them.
//
// Degenerate: with one key the value is constant; quaternions that are opposite or nearly equal are
// interpolated by a straight line, and one of length 0 is no rotation.
#include "scenes/animation/interpolate.h"

#include <algorithm>
#include <cmath>

namespace delray::scenes::internal {
namespace {

using Interpolation = AnimationChannel::Interpolation;

// From here on the sines of the arc's parts are as long as the parts.
constexpr double kNearlyEqual = 1 - 1e-9;

void normalize_rotation(std::span<double> q) {
  double square = 0;
  for (const double x : q) square += x * x;
  if (!(square > 0)) {
    std::ranges::fill(q, 0.0);
    q.back() = 1;
    return;
  }
  const double length = std::sqrt(square);
  for (double& x : q) x /= length;
}

// On the shorter arc from a to b, which have about unit length.
void interpolate_arc(const float* a, const float* b, double part, std::span<double> value) {
  double cosine = 0;
  for (std::size_t k = 0; k < value.size(); ++k) cosine += double{a[k]} * double{b[k]};
  const double sign = cosine < 0 ? -1 : 1;
  cosine = std::min(std::abs(cosine), 1.0);
  double of_a = 1 - part, of_b = part;
  if (cosine < kNearlyEqual) {
    const double angle = std::acos(cosine), sine = std::sin(angle);
    of_a = std::sin((1 - part) * angle) / sine;
    of_b = std::sin(part * angle) / sine;
  }
  for (std::size_t k = 0; k < value.size(); ++k)
    value[k] = of_a * double{a[k]} + of_b * sign * double{b[k]};
}

}  // namespace

void interpolate(const AnimationChannel& channel, double seconds, std::span<double> value) {
  const std::size_t width = value.size();
  const bool is_cubic = channel.interpolation == Interpolation::cubic_spline;
  const std::size_t stride = is_cubic ? 3 * width : width;
  // What a key has: with a spline its value stands between its tangents.
  const auto key = [&](std::size_t i, std::size_t part) {
    return channel.values.data() + i * stride + (is_cubic ? part * width : 0);
  };
  const auto after =
      std::upper_bound(channel.times.begin(), channel.times.end(), seconds,
                       [](double t, float time) { return t < static_cast<double>(time); });
  const auto next = static_cast<std::size_t>(after - channel.times.begin());
  const bool holds =
      next == 0 || next == channel.times.size() || channel.interpolation == Interpolation::step;
  if (holds) {
    const float* const from = key(next == 0 ? 0 : next - 1, 1);
    for (std::size_t k = 0; k < width; ++k) value[k] = double{from[k]};
  } else {
    const std::size_t last = next - 1;
    const double begin = channel.times[last], span = double{channel.times[next]} - begin;
    const double s = (seconds - begin) / span;
    const float *const a = key(last, 1), *const b = key(next, 1);
    if (is_cubic) {
      const float *const out = key(last, 2), *const in = key(next, 0);
      const double s2 = s * s, s3 = s2 * s;
      const double of_a = 2 * s3 - 3 * s2 + 1, of_b = 3 * s2 - 2 * s3;
      const double of_out = span * (s3 - 2 * s2 + s), of_in = span * (s3 - s2);
      for (std::size_t k = 0; k < width; ++k) {
        value[k] = of_a * double{a[k]} + of_out * double{out[k]} + of_b * double{b[k]} +
                   of_in * double{in[k]};
      }
    } else if (channel.path == AnimationChannel::Path::rotation) {
      interpolate_arc(a, b, s, value);
    } else {
      for (std::size_t k = 0; k < width; ++k)
        value[k] = double{a[k]} + s * (double{b[k]} - double{a[k]});
    }
  }
  if (channel.path == AnimationChannel::Path::rotation) normalize_rotation(value);
}

}  // namespace delray::scenes::internal
