// Pixels of finished images become those of the interface: empty ones have image::kEmptyDepth or
// the colour {} in layers, and in the interface the background and a depth of 1.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>

#include "composite/layer.h"
#include "image/image.h"

namespace delray::icet {

// A channel from 0 to 1 as a byte, towards zero; 0 for NaN.
inline std::uint8_t byte_of(float value) {
  return static_cast<std::uint8_t>(255 * std::min(std::max(0.0F, value), 1.0F));
}
image::Rgba8 as_bytes(const glm::vec4& colour);
inline std::uint32_t word_of(image::Rgba8 colour) { return std::bit_cast<std::uint32_t>(colour); }

// Pixels of a finished image as the interface has them: empty ones get the background
// and the depth 1; where layers were blended, all are blended over the background, which is
// premultiplied as they are.
template <class Colour>
void put_background(image::BasicImage<Colour>& image, composite::PixelRange range,
                    const glm::vec4& background, bool blends);

// Changes the bits of pixels in which the background has ones, so that pixels of the
// background become {}, and back.
template <class Colour>
void exclusive_or(image::BasicImage<Colour>& image, composite::PixelRange range,
                  const glm::vec4& background);

extern template void put_background(image::Image8&, composite::PixelRange, const glm::vec4&, bool);
extern template void put_background(image::ImageF&, composite::PixelRange, const glm::vec4&, bool);

extern template void exclusive_or(image::Image8&, composite::PixelRange, const glm::vec4&);
extern template void exclusive_or(image::ImageF&, composite::PixelRange, const glm::vec4&);

// Colours of three floats get an alpha of 1, and lose it.
void add_alpha(const float* rgb, std::size_t pixels, image::RgbaF* to);
void drop_alpha(const image::RgbaF* colour, std::size_t pixels, float* rgb);

}  // namespace delray::icet
