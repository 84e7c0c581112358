// Which pixels of a range are covered: as bits to compute with, and as the bytes that travel.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "parallel/function_ref.h"

namespace delray::composite {

// The pixels of a range are taken in groups, the last of which may be smaller.
inline constexpr std::uint64_t kGroupPixels = 4096;

// Bit j of element i: pixel 64 i + j of the group. Bits beyond the group's end are 0.
using GroupMask = std::array<std::uint64_t, kGroupPixels / 64>;

// Encoded, an empty or full range takes 8 bytes, one with scattered pixels 0.13 bytes per pixel, a
// compact shape little more than 10 bytes per line of it and 0.005 bytes per pixel of the lines:
//
//   u64 covered pixels; nothing follows if that is none or all
//   u16 covered pixels of each group, padded with zeros to a multiple of 8 bytes
//   for each group that is covered in part, two u64, bit i about pixels 64 i to 64 i + 63:
//     any of them is covered; all that lie in the group are
//   for each such group, u64 element i of its mask where bit i of the first is set, of the second
//     not
class Coverage {
 public:
  struct Group {
    std::uint64_t begin = 0, end = 0;  // pixels, counted from the start of the range
    std::uint64_t covered = 0;         // how many of them
    std::uint64_t covered_before = 0;  // in all groups before
    bool is_full() const { return covered == end - begin; }
  };

  // The coverage of a range of `pixels`: find(begin, end, mask) sets the bits of those pixels of
  // the range, which are a group, in a mask that is zero, and returns how many it set; it is called
  // for each group, by several threads. O(pixels).
  Coverage(
      std::uint64_t pixels,
      parallel::FunctionRef<std::uint64_t(std::uint64_t begin, std::uint64_t end, GroupMask& mask)>
          find);
  // Reads what encode wrote for a range of `pixels`, at the start of a message. Throws
  // comm::BadMessage for what it cannot have written: masks and counts agree, and nothing lies
  // outside of the range.
  Coverage(std::uint64_t pixels, std::span<const std::byte> message);

  std::uint64_t covered() const { return covered_before_.back(); }
  std::size_t groups() const { return covered_before_.size() - 1; }
  Group group(std::size_t i) const {
    const std::uint64_t begin = i * kGroupPixels;
    return {begin, std::min(begin + kGroupPixels, pixels_),
            covered_before_[i + 1] - covered_before_[i], covered_before_[i]};
  }
  // REQUIRES: some pixels of the group are covered and some are not.
  const GroupMask& mask(std::size_t group) const { return masks_[group]; }

  // A multiple of 8.
  std::size_t encoded_bytes() const { return encoded_bytes_; }
  // Returns the end of what it wrote.
  std::byte* encode(std::byte* to) const;

 private:
  // Bit i: whether element i of a group's mask has any bit, and whether it has all.
  struct Blocks {
    std::uint64_t any = 0, full = 0;
    std::uint64_t mixed() const { return any & ~full; }
  };

  std::uint64_t group_size(std::size_t i) const {
    return std::min(kGroupPixels, pixels_ - i * kGroupPixels);
  }
  bool is_mixed(std::size_t i) const {
    const Group at = group(i);
    return at.covered > 0 && !at.is_full();
  }

  std::uint64_t pixels_;
  std::vector<std::uint64_t> covered_before_;  // one more than there are groups
  std::unique_ptr<GroupMask[]> masks_;         // only those of groups covered in part are set
  std::vector<Blocks> blocks_;                 // of these masks
  std::size_t encoded_bytes_ = sizeof(std::uint64_t);
};

// Calls f(pixel, k) in ascending order for the covered pixels of a group: k counts them from 0,
// pixels count from the start of the range.
template <class F>
void for_each_covered(const Coverage& coverage, std::size_t group, F&& f) {
  const Coverage::Group at = coverage.group(group);
  if (at.covered == 0) return;
  if (at.is_full()) {
    for (std::uint64_t pixel = at.begin; pixel < at.end; ++pixel) f(pixel, pixel - at.begin);
    return;
  }
  const GroupMask& mask = coverage.mask(group);
  std::uint64_t k = 0;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    for (std::uint64_t bits = mask[i]; bits != 0; bits &= bits - 1) {
      f(at.begin + i * 64 + static_cast<std::uint64_t>(std::countr_zero(bits)), k++);
    }
  }
}

}  // namespace delray::composite
