// Bounding rectangles: of a range all pixels travel that lie in the rectangle around covered ones.
#pragma once

#include "composite/image_layer.h"

namespace delray::composite {

// A message is four u32, the columns x0 <= x < x1 and rows y0 <= y < y1 of the image, and then of
// those pixels of the range that lie in them, row by row, the colours and after them the depths,
// where there are any. Pixels that travel count as composited. O(pixels of the range) to cut.
template <class Colour>
class BoundsLayer final : public ImageLayer<Colour> {
 public:
  using ImageLayer<Colour>::ImageLayer;

  comm::Buffer encode(PixelRange range) override;

 private:
  using typename ImageLayer<Colour>::Action;
  std::uint64_t apply(PixelRange range, const comm::Buffer& pixels, Action action) override;
};

extern template class BoundsLayer<image::Rgba8>;
extern template class BoundsLayer<image::RgbaF>;

std::unique_ptr<Layer> make_bounds(image::Image8&& image, Operator how = Operator::nearest);
std::unique_ptr<Layer> make_bounds(image::ImageF&& image, Operator how = Operator::nearest);

}  // namespace delray::composite
