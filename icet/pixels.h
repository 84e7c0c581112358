// Pixels of finished images become those of the interface, which have the background and a depth
// of 1 where nothing is seen.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "composite/layer.h"
#include "image/image.h"

namespace delray::icet {

// A channel from 0 to 1 as a byte, towards zero; 0 for NaN.
inline std::uint8_t byte_of(float value) {
  return static_cast<std::uint8_t>(255 * std::min(std::max(0.0F, value), 1.0F));
}
image::Rgba8 as_bytes(const glm::vec4& colour);
// The colour as one of the type of the second argument.
inline image::Rgba8 as(const glm::vec4& colour, image::Rgba8 /*type*/) { return as_bytes(colour); }
inline image::RgbaF as(const glm::vec4& colour, image::RgbaF /*type*/) {
  return {colour.r, colour.g, colour.b, colour.a};
}
inline std::uint32_t word_of(image::Rgba8 colour) { return std::bit_cast<std::uint32_t>(colour); }

// Pixels of an image whose layers were blended are blended over the background, which is
// premultiplied as they are.
template <class Colour>
void blend_over(image::BasicImage<Colour>& image, composite::PixelRange range, Colour background);

// image::kEmptyDepth becomes 1.
void set_empty_depths(std::span<float> depths);

// Changes the bits of pixels in which the background has ones, so that pixels of the
// background become {}, and back.
template <class Colour>
void exclusive_or(image::BasicImage<Colour>& image, composite::PixelRange range, Colour background);

extern template void blend_over(image::Image8&, composite::PixelRange, image::Rgba8);
extern template void blend_over(image::ImageF&, composite::PixelRange, image::RgbaF);

extern template void exclusive_or(image::Image8&, composite::PixelRange, image::Rgba8);
extern template void exclusive_or(image::ImageF&, composite::PixelRange, image::RgbaF);

// Colours of three floats get an alpha of 1, and lose it.
void add_alpha(const float* rgb, std::size_t pixels, image::RgbaF* to);
void drop_alpha(const image::RgbaF* colour, std::size_t pixels, float* rgb);

}  // namespace delray::icet
