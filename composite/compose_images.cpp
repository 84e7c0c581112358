// Composition and gather of images in one call. Pixels in somebody else's memory are copied first,
// so that empty ones look as layers expect them.
#include "composite/compose_images.h"

#include <algorithm>
#include <utility>

#include "composite/codec.h"
#include "parallel/parallel_for.h"

namespace delray::composite {

template <class Colour>
image::BasicImage<Colour> compose_images(comm::Communicator& communicator,
                                         image::BasicImage<Colour>&& image,
                                         const ImageOptions& options) {
  const Codec* const codec = find_codec(options.codec);
  // Without a layer all ranks hear of it there.
  OwnedPixels part =
      compose(communicator, codec != nullptr ? codec->make(std::move(image), options.how) : nullptr,
              options.scheme, {.interlace = options.interlace});
  part = gather(communicator, std::move(part), options.root);
  if (communicator.rank() != options.root) return {};
  return take_image<Colour>(std::move(part));
}

template <class Colour>
image::BasicImage<Colour> compose_images(comm::Communicator& communicator,
                                         const ImageBuffers<Colour>& buffers, float empty_depth,
                                         const ImageOptions& options) {
  const bool has_pixels = buffers.width > 0 && buffers.height > 0;
  if (buffers.width < 0 || buffers.height < 0 || (has_pixels && buffers.colour == nullptr) ||
      (has_pixels && buffers.depth == nullptr && options.how != Operator::over)) {
    // All ranks hear of it.
    compose(communicator, nullptr, options.scheme, {.interlace = options.interlace});
  }
  constexpr std::size_t kGrain = std::size_t{1} << 15;  // pixels; about 30 microseconds
  image::BasicImage<Colour> image(buffers.width, buffers.height);
  parallel::parallel_blocks(0, image.pixels(), kGrain, [&](std::size_t begin, std::size_t end) {
    if (buffers.depth == nullptr) {
      std::copy(buffers.colour + begin, buffers.colour + end, image.colour.data() + begin);
      std::fill(image.depth.data() + begin, image.depth.data() + end, image::kEmptyDepth);
      return;
    }
    for (std::size_t i = begin; i < end; ++i) {
      const bool empty = buffers.depth[i] == empty_depth && options.how == Operator::nearest;
      image.depth[i] = empty ? image::kEmptyDepth : buffers.depth[i];
      image.colour[i] = empty ? Colour{} : buffers.colour[i];
    }
  });
  return compose_images(communicator, std::move(image), options);
}

template image::Image8 compose_images(comm::Communicator&, image::Image8&&, const ImageOptions&);
template image::ImageF compose_images(comm::Communicator&, image::ImageF&&, const ImageOptions&);
template image::Image8 compose_images(comm::Communicator&, const ImageBuffers<image::Rgba8>&, float,
                                      const ImageOptions&);
template image::ImageF compose_images(comm::Communicator&, const ImageBuffers<image::RgbaF>&, float,
                                      const ImageOptions&);

}  // namespace delray::composite
