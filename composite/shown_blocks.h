// Where in an image there may be anything.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "composite/coverage.h"

namespace delray::composite {

// Which blocks of 64 consecutive pixels of an image may show anything. The others are clear, so
// that they need not be looked at.
class ShownBlocks {
 public:
  static constexpr std::size_t kPixels = 64;

  // Nothing is known of any image.
  ShownBlocks() = default;
  // None of an image of so many pixels.
  explicit ShownBlocks(std::size_t pixels) : bits_(pixels / (kPixels * kBits) + 2) {}

  bool is_known() const { return !bits_.empty(); }

  // Whether a block may that has any of the pixels [first, first + size).
  //
  // REQUIRES of this and add: is_known(); size >= 1; at most kPixels of them are beyond the end.
  bool any(std::size_t first, std::size_t size) const {
    const std::size_t last = (first + size - 1) / kPixels;
    for (std::size_t block = first / kPixels; block <= last; ++block)
      if ((bits_[block / kBits] >> block % kBits & 1) != 0) return true;
    return false;
  }
  // These may. Several threads may call it.
  void add(std::size_t first, std::size_t size) {
    const std::size_t last = (first + size - 1) / kPixels;
    for (std::size_t block = first / kPixels; block <= last; ++block) {
      const std::atomic_ref word(bits_[block / kBits]);
      const std::uint64_t bit = std::uint64_t{1} << block % kBits;
      if ((word.load(std::memory_order_relaxed) & bit) == 0)
        word.fetch_or(bit, std::memory_order_relaxed);
    }
  }
  // Those of the covered pixels of a group that begins at `first`.
  void add(std::size_t first, const GroupMask& mask) {
    for (std::size_t i = 0; i < mask.size(); ++i)
      if (mask[i] != 0) add(first + i * kPixels, kPixels);
  }

 private:
  static constexpr std::size_t kBits = 64;

  std::vector<std::uint64_t> bits_;
};

}  // namespace delray::composite
