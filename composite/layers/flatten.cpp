// Blends the fragments of all pixels, in parallel over blocks of pixels.
#include "composite/flatten.h"

#include "parallel/parallel_for.h"

namespace delray::composite {

template <class Colour>
image::BasicImage<Colour> flatten(const DeepImage<image::RgbaF>& deep) {
  constexpr std::size_t kGrain = std::size_t{1} << 14;  // pixels: some tens of microseconds
  image::BasicImage<Colour> result(deep.width, deep.height);
  parallel::parallel_blocks(0, deep.lists.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    flatten(deep, begin, end, result,
            [](const image::RgbaF& colour) { return std::optional(colour); });
  });
  return result;
}

template image::Image8 flatten(const DeepImage<image::RgbaF>& deep);
template image::ImageF flatten(const DeepImage<image::RgbaF>& deep);

}  // namespace delray::composite
