// Base of all layers without pixels, which only take time.
#pragma once

#include <cmath>

#include "composite/metadata_only.h"

namespace delray::composite::internal {

class MetadataOnlyLayer : public Layer {
 public:
  MetadataOnlyLayer(std::size_t pixel_bytes, const LayerClock& clock)
      : pixel_bytes_(pixel_bytes), clock_(clock) {}

 protected:
  std::size_t pixel_bytes() const { return pixel_bytes_; }

  void charge_cut(PixelRange range, std::size_t bytes) const {
    charge(clock_.costs.encode + clock_.costs.encode_pixel * static_cast<double>(range.size()) +
           clock_.costs.encode_byte * static_cast<double>(bytes));
  }
  void charge_merge(PixelRange range) const {
    charge(clock_.costs.merge + clock_.costs.merge_pixel * static_cast<double>(range.size()));
  }
  // Bytes are written once more, into the image.
  void charge_replace(std::size_t bytes) const {
    charge(clock_.costs.merge + clock_.costs.encode_byte * static_cast<double>(bytes));
  }

 private:
  void charge(double seconds) const {
    if (!clock_.communicator || seconds <= 0) return;
    clock_.communicator->work(comm::Work::seconds_e9,
                              static_cast<std::uint64_t>(std::llround(seconds * 1e9)));
  }

  std::size_t pixel_bytes_;
  LayerClock clock_;
};

}  // namespace delray::composite::internal
