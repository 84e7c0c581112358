// The last step of deep compositing: the owner of a pixel blends its fragments, once.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "composite/deep_image.h"
#include "composite/fragment.h"
#include "image/image.h"

namespace delray::composite {

// Blends pixels begin <= i < end of `deep` into `image`, of the same size; the depth is that of the
// first fragment that is seen. colour_of(payload) gives its std::optional<image::RgbaF>: nothing
// where it is not seen. One thread; O(pixels + fragments).
template <class Colour, class Payload, class F>
void flatten(const DeepImage<Payload>& deep, std::size_t begin, std::size_t end,
             image::BasicImage<Colour>& image, F&& colour_of) {
  std::vector<Fragment> seen;
  for (std::size_t i = begin; i < end; ++i) {
    seen.clear();
    for (const DeepFragment<Payload>& fragment : deep.at(i)) {
      const std::optional<image::RgbaF> colour = colour_of(fragment.payload);
      if (colour) seen.push_back({*colour, fragment.depth, 0, 0});
    }
    image.colour[i] = {};
    image.depth[i] = seen.empty() ? image::kEmptyDepth : seen.front().depth;
    if (!seen.empty()) store(blend(seen), image.colour[i]);
  }
}

// All pixels of an image whose fragments are colours. Parallel.
template <class Colour>
image::BasicImage<Colour> flatten(const DeepImage<image::RgbaF>& deep);

extern template image::Image8 flatten(const DeepImage<image::RgbaF>& deep);
extern template image::ImageF flatten(const DeepImage<image::RgbaF>& deep);

}  // namespace delray::composite
