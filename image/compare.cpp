// Compares pictures bit by bit in a parallel reduction and draws their amplified difference.
// Degenerate: two NaN of different bits differ, but by 0.
#include "image/compare.h"

#include <bit>
#include <cassert>
#include <cmath>
#include <cstdlib>

#include "parallel/parallel_for.h"

namespace delray::image {
namespace {

constexpr std::size_t kCompareGrain = std::size_t{1} << 15;  // pixels; about 50 microseconds

double channel_difference(std::uint8_t a, std::uint8_t b) { return std::abs(a - b); }

double channel_difference(float a, float b) {
  if (std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b)) return 0;
  if (std::isnan(a) && std::isnan(b)) return 0;
  const double difference = std::abs(static_cast<double>(a) - static_cast<double>(b));
  return std::isnan(difference) ? std::numeric_limits<double>::infinity() : difference;
}

bool same_bits(const Rgba8& a, const Rgba8& b) { return a == b; }

bool same_bits(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

bool same_bits(const RgbaF& a, const RgbaF& b) {
  return same_bits(a.r, b.r) && same_bits(a.g, b.g) && same_bits(a.b, b.b) && same_bits(a.a, b.a);
}

template <class Colour>
double largest_difference(const Colour& a, const Colour& b) {
  return std::max({channel_difference(a.r, b.r), channel_difference(a.g, b.g),
                   channel_difference(a.b, b.b), channel_difference(a.a, b.a)});
}

Comparison sum(const Comparison& a, const Comparison& b) {
  return {a.colour_differs + b.colour_differs, a.depth_differs + b.depth_differs,
          a.coverage_differs + b.coverage_differs,
          std::max(a.max_channel_difference, b.max_channel_difference)};
}

template <class Colour>
Comparison compare_pixels(const BasicImage<Colour>& a, const BasicImage<Colour>& b) {
  assert(a.width == b.width && a.height == b.height);
  const auto block = [&](std::size_t first, std::size_t last) {
    Comparison result;
    for (std::size_t i = first; i < last; ++i) {
      if (!same_bits(a.colour[i], b.colour[i])) {
        ++result.colour_differs;
        result.max_channel_difference =
            std::max(result.max_channel_difference, largest_difference(a.colour[i], b.colour[i]));
      }
      result.depth_differs += same_bits(a.depth[i], b.depth[i]) ? 0 : 1;
      result.coverage_differs += (a.depth[i] < kEmptyDepth) != (b.depth[i] < kEmptyDepth) ? 1 : 0;
    }
    return result;
  };
  return parallel::parallel_reduce(0, a.pixels(), kCompareGrain, Comparison{}, block, sum);
}

}  // namespace

Comparison compare(const Image8& a, const Image8& b) { return compare_pixels(a, b); }
Comparison compare(const ImageF& a, const ImageF& b) { return compare_pixels(a, b); }

Image8 difference_picture(const Image8& a, const Image8& b, int gain) {
  assert(a.width == b.width && a.height == b.height && gain >= 1);
  const auto code = [gain](std::uint8_t s, std::uint8_t t) {
    return static_cast<std::uint8_t>(
        std::min<std::int64_t>(255, std::int64_t{std::abs(s - t)} * gain));
  };
  Image8 result(a.width, a.height);
  parallel::parallel_for(0, a.pixels(), kCompareGrain, [&](std::size_t i) {
    const Rgba8 s = a.colour[i], t = b.colour[i];
    Rgba8 difference{code(s.r, t.r), code(s.g, t.g), code(s.b, t.b), 255};
    if (difference == Rgba8{0, 0, 0, 255}) difference.b = code(s.a, t.a);
    result.colour[i] = difference;
    result.depth[i] = 0;
  });
  return result;
}

}  // namespace delray::image
