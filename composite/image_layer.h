// Layers of opaque images, merged by z-test: how one travels is its codec's affair.
#pragma once

#include <memory>
#include <utility>

#include "composite/layer.h"
#include "image/image.h"
#include "image/operators.h"

namespace delray::composite {

// Owns the image. A codec derives from it, for cut, merge and replace. The nearer pixel wins, the
// lower interval of ranks on equal depths. A pixel that nothing covers has kEmptyDepth and the
// colour {}, so that every codec leaves the same bytes.
template <class Colour>
class ImageLayer : public Layer {
 public:
  explicit ImageLayer(image::BasicImage<Colour>&& image) : image_(std::move(image)) {}

  image::BasicImage<Colour>& image() { return image_; }
  const image::BasicImage<Colour>& image() const { return image_; }

  std::uint64_t pixels() const final { return image_.pixels(); }
  bool empty() const final;

 protected:
  static image::Tie tie_of(Side from) {
    return from == Side::lower ? image::Tie::other : image::Tie::target;
  }

 private:
  image::BasicImage<Colour> image_;
};

extern template class ImageLayer<image::Rgba8>;
extern template class ImageLayer<image::RgbaF>;

// The image of a part; only the part's ranges of it are final.
//
// REQUIRES: the part's layer is an ImageLayer<Colour>, whatever its codec.
template <class Colour>
image::BasicImage<Colour> take_image(Part&& part) {
  return std::move(dynamic_cast<ImageLayer<Colour>&>(*part.layer).image());
}

}  // namespace delray::composite
