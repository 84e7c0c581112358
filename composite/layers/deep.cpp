// Stores flattened colours as pixels of either format, and instantiates the layer whose fragments
// are colours.
#include "composite/deep.h"

#include "image/srgb.h"

namespace delray::composite {

void store(const image::RgbaF& colour, image::RgbaF& pixel) { pixel = colour; }

void store(const image::RgbaF& colour, image::Rgba8& pixel) {
  constexpr float kLargest = 255.0F, kHalf = 0.5F;
  const float alpha = std::clamp(colour.a, 0.0F, 1.0F) * kLargest + kHalf;
  pixel = {image::encode_srgb(colour.r), image::encode_srgb(colour.g), image::encode_srgb(colour.b),
           static_cast<std::uint8_t>(alpha)};
}

template class DeepLayer<image::RgbaF>;

}  // namespace delray::composite
