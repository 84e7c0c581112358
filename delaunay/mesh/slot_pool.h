// Free slots of a mesh that several kernels take from.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <utility>

#include "delaunay/mesh/mesh.h"

namespace delray::delaunay::internal {

class SlotPool {
 public:
  // Slots [first, last) are free.
  SlotPool(SimplexNumber first, std::size_t last) : next_(first), last_(last) {}

  // The first and the last of some slots, equal if there are none left.
  std::pair<SimplexNumber, SimplexNumber> take() {
    const std::size_t first = std::min(next_.fetch_add(kChunk), last_);
    return {static_cast<SimplexNumber>(first),
            static_cast<SimplexNumber>(std::min(first + kChunk, last_))};
  }

  // The number of slots that were taken or were not free.
  std::size_t used() const { return std::min(next_.load(), last_); }
  // While nobody takes.
  void extend(std::size_t last) {
    next_ = used();
    last_ = last;
  }

  // Enough for some hundred points, and little where it stays unused.
  static constexpr std::size_t kChunk = 2048;

 private:
  std::atomic<std::size_t> next_;
  std::size_t last_;
};

}  // namespace delray::delaunay::internal
