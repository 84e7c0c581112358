// Dense layers: every pixel of a range travels, covered or not, as colour and depth.
#pragma once

#include "composite/layer.h"
#include "image/image.h"

namespace delray::composite {

// Visibility by z-test: the nearer pixel wins, the lower interval of ranks on equal depths. A
// message is the range's colours, then its depths: 8 bytes per pixel of Rgba8, 20 of RgbaF. Every
// pixel of a merged range counts as composited.
//
// merge and cut run in the caller's arena.
template <class Colour>
class DenseLayer final : public Layer {
 public:
  explicit DenseLayer(image::BasicImage<Colour>&& image) : image_(std::move(image)) {}

  image::BasicImage<Colour>& image() { return image_; }
  const image::BasicImage<Colour>& image() const { return image_; }

  std::uint64_t pixels() const override { return image_.pixels(); }
  comm::Buffer cut(PixelRange range) override;
  std::uint64_t merge(PixelRange range, const comm::Buffer& pixels, Side from) override;
  void replace(PixelRange range, const comm::Buffer& pixels) override;
  bool empty() const override;

 private:
  image::BasicImage<Colour> image_;
};

extern template class DenseLayer<image::Rgba8>;
extern template class DenseLayer<image::RgbaF>;

std::unique_ptr<Layer> make_dense(image::Image8&& image);
std::unique_ptr<Layer> make_dense(image::ImageF&& image);

// The image of a part that began as make_dense; only the part's ranges of it are final.
//
// REQUIRES: the part's layer is a DenseLayer<Colour>.
template <class Colour>
image::BasicImage<Colour> take_image(Part&& part) {
  return std::move(dynamic_cast<DenseLayer<Colour>&>(*part.layer).image());
}

}  // namespace delray::composite
