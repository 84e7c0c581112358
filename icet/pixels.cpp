// Loops over pixels, written so that the compiler makes vectors of them: selections without
// branches.
#include "icet/pixels.h"

#include <algorithm>
#include <array>

namespace delray::icet {
namespace {

using image::Rgba8;
using image::RgbaF;

// value / 255, rounded; exact for products of two bytes.
unsigned divided_by_255(unsigned value) {
  value += 128;
  return (value + (value >> 8)) >> 8;
}

// As image::blend_back does it, of one colour behind all pixels.
void blend_over(Rgba8* pixels, std::size_t size, Rgba8 behind) {
  auto* const bytes = reinterpret_cast<std::uint8_t*>(pixels);
  const std::uint8_t back[4] = {behind.r, behind.g, behind.b, behind.a};
  for (std::size_t i = 0; i < size; ++i) {
    const unsigned through = 255U - bytes[4 * i + 3];
    for (std::size_t k = 0; k < 4; ++k) {
      const unsigned sum = bytes[4 * i + k] + divided_by_255(back[k] * through);
      bytes[4 * i + k] = static_cast<std::uint8_t>(std::min(sum, 255U));
    }
  }
}

void blend_over(RgbaF* pixels, std::size_t size, RgbaF behind) {
  for (std::size_t i = 0; i < size; ++i) {
    RgbaF& pixel = pixels[i];
    const float through = 1.0F - pixel.a;
    pixel.r += behind.r * through;
    pixel.g += behind.g * through;
    pixel.b += behind.b * through;
    pixel.a += behind.a * through;
  }
}

}  // namespace

Rgba8 as_bytes(const glm::vec4& colour) {
  return {byte_of(colour.r), byte_of(colour.g), byte_of(colour.b), byte_of(colour.a)};
}

template <class Colour>
void blend_over(image::BasicImage<Colour>& image, composite::PixelRange range, Colour background) {
  if (background == Colour{}) return;
  blend_over(image.colour.data() + range.begin, range.size(), background);
}

void set_empty_depths(std::span<float> depths) {
  for (float& depth : depths) depth = depth == image::kEmptyDepth ? 1 : depth;
}

template <class Colour>
void exclusive_or(image::BasicImage<Colour>& image, composite::PixelRange range,
                  Colour background) {
  constexpr std::size_t kWords = sizeof(Colour) / sizeof(std::uint32_t);
  if (background == Colour{}) return;
  const auto bits = std::bit_cast<std::array<std::uint32_t, kWords>>(background);
  auto* const words = reinterpret_cast<std::uint32_t*>(image.colour.data());
  for (std::size_t i = range.begin; i < range.end; ++i) {
    for (std::size_t k = 0; k < kWords; ++k) words[i * kWords + k] ^= bits[k];
  }
}

template void blend_over(image::Image8&, composite::PixelRange, Rgba8);
template void blend_over(image::ImageF&, composite::PixelRange, RgbaF);

template void exclusive_or(image::Image8&, composite::PixelRange, Rgba8);
template void exclusive_or(image::ImageF&, composite::PixelRange, RgbaF);

void add_alpha(const float* rgb, std::size_t pixels, RgbaF* to) {
  for (std::size_t i = 0; i < pixels; ++i, rgb += 3) to[i] = {rgb[0], rgb[1], rgb[2], 1};
}

void drop_alpha(const RgbaF* colour, std::size_t pixels, float* rgb) {
  for (std::size_t i = 0; i < pixels; ++i, rgb += 3) {
    rgb[0] = colour[i].r;
    rgb[1] = colour[i].g;
    rgb[2] = colour[i].b;
  }
}

}  // namespace delray::icet
