#include "composite/image_layer.h"

#include <algorithm>

namespace delray::composite {

template <class Colour>
bool ImageLayer<Colour>::empty() const {
  constexpr std::size_t kBlock = 4096;  // between tests: no branch inside, so it is vectorised
  for (std::size_t begin = 0; begin < image_.pixels(); begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, image_.pixels());
    unsigned covered = 0;
    for (std::size_t i = begin; i < end; ++i) covered |= image_.depth[i] != image::kEmptyDepth;
    if (covered != 0) return false;
  }
  return true;
}

template class ImageLayer<image::Rgba8>;
template class ImageLayer<image::RgbaF>;

}  // namespace delray::composite
