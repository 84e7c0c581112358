// A rank's partial image, which compositing schemes see only as ranges of pixels.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "comm/buffer.h"

namespace delray::composite {

// Pixels begin <= i < end in row-major order.
struct PixelRange {
  std::uint64_t begin = 0, end = 0;
  std::uint64_t size() const { return end - begin; }
  bool operator==(const PixelRange&) const = default;
};

// Which ranks a received buffer comes from, relative to those already in the layer. Schemes merge
// neighbouring intervals of ranks only; the lower one wins ties and lies in front.
enum class Side : std::uint8_t { lower, higher };

// A partial image. Schemes do not know what a pixel is; a layer does not know what a rank is.
class Layer {
 public:
  virtual ~Layer() = default;
  virtual std::uint64_t pixels() const = 0;
  // The pixels of `range`, encoded for the other end's merge. The layer keeps its copy.
  virtual comm::Buffer encode(PixelRange range) = 0;
  // Merges what encode(range) gave on another rank. Returns the number of pixels composited.
  virtual std::uint64_t merge(PixelRange range, const comm::Buffer& pixels, Side from) = 0;
  // Replaces `range` by what encode(range) gave on another rank.
  virtual void replace(PixelRange range, const comm::Buffer& pixels) = 0;
  // Forgets pixels of `range` that are certainly hidden by what encode(range) gave on a lower rank.
  // Returns the number of pixels compared.
  virtual std::uint64_t prune(PixelRange /*range*/, const comm::Buffer& /*pixels*/) { return 0; }
  // Layers of one type and another format do not understand what the other's encode gives.
  virtual int format() const { return 0; }
  // Nothing in it: the rank may stay out of the exchange.
  virtual bool empty() const = 0;
};

// The pixels that a rank owns after a scheme: final ones in `ranges` of `layer`, the rest of it is
// garbage.
struct OwnedPixels {
  std::vector<PixelRange> ranges;
  std::unique_ptr<Layer> layer;
};

}  // namespace delray::composite
