// Dense layers: every pixel of a range travels, covered or not, as colour and depth.
#pragma once

#include "composite/image_layer.h"

namespace delray::composite {

// A message is the range's colours, then its depths, where there are any: of Rgba8 8 bytes per
// pixel, or 4 without depth, of RgbaF 20 or 16. Every pixel of a merged range counts as composited.
//
// merge and encode run in the caller's arena.
template <class Colour>
class DenseLayer final : public ImageLayer<Colour> {
 public:
  using ImageLayer<Colour>::ImageLayer;

  comm::Buffer encode(PixelRange range) override;

 private:
  using typename ImageLayer<Colour>::Action;
  std::uint64_t apply(PixelRange range, const comm::Buffer& pixels, Action action) override;
};

extern template class DenseLayer<image::Rgba8>;
extern template class DenseLayer<image::RgbaF>;

std::unique_ptr<Layer> make_dense(image::Image8&& image, Operator how = Operator::nearest);
std::unique_ptr<Layer> make_dense(image::ImageF&& image, Operator how = Operator::nearest);

}  // namespace delray::composite
