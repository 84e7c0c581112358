// Active-pixel layers: of a range only the covered pixels travel.
#pragma once

#include "composite/image_layer.h"

namespace delray::composite {

// A message is the coverage of the range (see Coverage), then the colours of its covered pixels,
// then their depths, where there are any: of an empty range 8 bytes, of a full one 8 more than that
// of a dense layer. Covered pixels that arrive count as composited; those that do not are not
// touched.
//
// Coverage is found anew by every encoding: merging adds to it. encode, merge and replace run in
// the caller's arena, merge straight from the message.
template <class Colour>
class ActiveLayer : public ImageLayer<Colour> {
 public:
  using ImageLayer<Colour>::ImageLayer;

  comm::Buffer encode(PixelRange range) override;

 protected:
  using typename ImageLayer<Colour>::Action;
  std::uint64_t apply(PixelRange range, const comm::Buffer& pixels, Action action) override;
  // Does what apply does, with a message whose coverage was read.
  std::uint64_t apply_covered(PixelRange range, const Coverage& coverage,
                              const comm::Buffer& pixels, Action action);
};

extern template class ActiveLayer<image::Rgba8>;
extern template class ActiveLayer<image::RgbaF>;

std::unique_ptr<Layer> make_active(image::Image8&& image, Operator how = Operator::nearest);
std::unique_ptr<Layer> make_active(image::ImageF&& image, Operator how = Operator::nearest);

}  // namespace delray::composite
