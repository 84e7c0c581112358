// LZ4 over active pixels: for networks that are slower than compressing.
#pragma once

#include "composite/layers/active.h"

namespace delray::composite {

// A message is what an active layer's is, in blocks that are compressed on their own. Of a block
// each value of four bytes is replaced by its difference to the one before, and the first bytes of
// all values come first, then the second ones: what is alike lies together.
//
//   u64 bytes of the active layer's message
//   u64 for each block of 1 MiB of it: bytes in the message, as many as the block has if it could
//     not be made smaller
//   the blocks
//
// encode, merge and replace run in the caller's arena, a block at a time.
template <class Colour>
class Lz4Layer final : public ActiveLayer<Colour> {
 public:
  using ActiveLayer<Colour>::ActiveLayer;

  comm::Buffer encode(PixelRange range) override;

 private:
  using typename ImageLayer<Colour>::Action;
  std::uint64_t apply(PixelRange range, const comm::Buffer& pixels, Action action) override;
};

extern template class Lz4Layer<image::Rgba8>;
extern template class Lz4Layer<image::RgbaF>;

std::unique_ptr<Layer> make_lz4(image::Image8&& image, Operator how = Operator::nearest);
std::unique_ptr<Layer> make_lz4(image::ImageF&& image, Operator how = Operator::nearest);

}  // namespace delray::composite
