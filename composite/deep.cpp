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

template <class Colour>
image::BasicImage<Colour> flatten(const DeepImage<image::RgbaF>& deep) {
  constexpr std::size_t kGrain = std::size_t{1} << 14;  // pixels: some tens of microseconds
  image::BasicImage<Colour> result(deep.width, deep.height);
  parallel::parallel_for(0, deep.lists.size(), kGrain, [&](std::size_t i) {
    const std::span<const Fragment> fragments = deep.at(i);
    result.colour[i] = {};
    result.depth[i] = fragments.empty() ? image::kEmptyDepth : fragments.front().depth;
    if (!fragments.empty()) store(blend(fragments), result.colour[i]);
  });
  return result;
}

template image::Image8 flatten(const DeepImage<image::RgbaF>& deep);
template image::ImageF flatten(const DeepImage<image::RgbaF>& deep);

template class DeepLayer<image::RgbaF>;

}  // namespace delray::composite
