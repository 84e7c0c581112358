// The table of tone curves, among them a rational fit of the ACES reference rendering (Narkowicz
// 2016), applied to straight colour: light is divided by alpha before and multiplied after.
// Degenerate: negative and NaN channels become 0, light without coverage counts as opaque.
#include "image/tone.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "parallel/parallel_for.h"

namespace delray::image {
namespace {

constexpr std::size_t kToneGrain = 4096;  // pixels: some ten microseconds

float linear(float light) { return light; }

// A rational fit of the reference rendering of the Academy Color Encoding System (Narkowicz 2016):
// a toe that deepens shadows, a shoulder that lets highlights run out softly.
float filmic(float light) {
  const float x = std::min(light, 1e6F);
  const float y = (x * (2.51F * x + 0.03F)) / (x * (2.43F * x + 0.59F) + 0.14F);
  return std::min(y, 1.0F);
}

constexpr std::array kCurves = {
    ToneCurve{"linear", "light as it is; what is brighter than white is cut off", linear},
    ToneCurve{"filmic", "deeper shadows, and highlights that run out softly, as on film", filmic},
};

float mapped(float channel, float factor, const ToneCurve& curve, float alpha) {
  // NaN fails the comparison.
  return channel > 0.0F ? curve.shown(channel / alpha * factor) * alpha : 0.0F;
}

}  // namespace

std::span<const ToneCurve> tone_curves() { return kCurves; }

const ToneCurve& tone_curve(std::string_view name) {
  std::string legal;
  for (const ToneCurve& curve : kCurves) {
    if (curve.name == name) return curve;
    legal += (legal.empty() ? "" : ", ") + std::string(curve.name);
  }
  throw std::invalid_argument("no tone curve is called '" + std::string(name) +
                              "'; there are: " + legal);
}

void map_tones(ImageF& picture, float factor, const ToneCurve& curve) {
  const std::size_t n = picture.pixels();
  parallel::parallel_for(0, (n + kToneGrain - 1) / kToneGrain, 1, [&](std::size_t block) {
    for (std::size_t i = block * kToneGrain; i < std::min(n, (block + 1) * kToneGrain); ++i) {
      RgbaF& pixel = picture.colour[i];
      // Light without any coverage, such as glow, is taken as if it were opaque.
      const float alpha = pixel.a > 0.0F ? pixel.a : 1.0F;
      pixel = {mapped(pixel.r, factor, curve, alpha), mapped(pixel.g, factor, curve, alpha),
               mapped(pixel.b, factor, curve, alpha), pixel.a};
    }
  });
}

}  // namespace delray::image
