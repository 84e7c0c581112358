// Dense layers: every pixel of a range travels, covered or not, as colour and depth.
#pragma once

#include "composite/image_layer.h"

namespace delray::composite {

// A message is the range's colours, then its depths: 8 bytes per pixel of Rgba8, 20 of RgbaF. Every
// pixel of a merged range counts as composited.
//
// merge and cut run in the caller's arena.
template <class Colour>
class DenseLayer final : public ImageLayer<Colour> {
 public:
  using ImageLayer<Colour>::ImageLayer;

  comm::Buffer cut(PixelRange range) override;
  std::uint64_t merge(PixelRange range, const comm::Buffer& pixels, Side from) override;
  void replace(PixelRange range, const comm::Buffer& pixels) override;
};

extern template class DenseLayer<image::Rgba8>;
extern template class DenseLayer<image::RgbaF>;

std::unique_ptr<Layer> make_dense(image::Image8&& image);
std::unique_ptr<Layer> make_dense(image::ImageF&& image);

}  // namespace delray::composite
