#include "composite/coverage.h"

#include <cstring>

#include "parallel/parallel_for.h"

namespace delray::composite {
namespace {

// Which elements of a mask have any bit, and which all.
struct Blocks {
  std::uint64_t any = 0, full = 0;
  std::uint64_t mixed() const { return any & ~full; }
};

// The element of a mask that has all bits of a group of `size` pixels.
std::uint64_t full_element(std::uint64_t size, std::size_t i) {
  const std::uint64_t begin = i * 64;
  if (size >= begin + 64) return ~std::uint64_t{0};
  return size > begin ? (std::uint64_t{1} << (size - begin)) - 1 : 0;
}

Blocks blocks_of(const GroupMask& mask, std::uint64_t size) {
  Blocks result;
  for (std::size_t i = 0; i * 64 < size; ++i) {
    result.any |= std::uint64_t{mask[i] != 0} << i;
    result.full |= std::uint64_t{mask[i] == full_element(size, i)} << i;
  }
  return result;
}

std::size_t groups_of(std::uint64_t pixels) { return (pixels + kGroupPixels - 1) / kGroupPixels; }

std::size_t bytes_of_counts(std::size_t groups) {
  return (groups * sizeof(std::uint16_t) + 7) / 8 * 8;
}

void sum_up(std::vector<std::uint64_t>& counts) {
  for (std::size_t i = 1; i < counts.size(); ++i) counts[i] += counts[i - 1];
}

template <class T>
std::byte* put(std::byte* to, const T& value) {
  std::memcpy(to, &value, sizeof value);
  return to + sizeof value;
}

template <class T>
const std::byte* take(const std::byte* from, T& value) {
  std::memcpy(&value, from, sizeof value);
  return from + sizeof value;
}

}  // namespace

Coverage::Coverage(
    std::uint64_t pixels,
    parallel::FunctionRef<std::uint64_t(std::uint64_t begin, std::uint64_t end, GroupMask& mask)>
        find)
    : pixels_(pixels), covered_before_(groups_of(pixels) + 1), masks_(new GroupMask[groups()]) {
  parallel::parallel_for(0, groups(), 1, [&](std::size_t i) {
    GroupMask& mask = masks_[i];
    mask.fill(0);
    covered_before_[i + 1] =
        find(i * kGroupPixels, std::min((i + 1) * kGroupPixels, pixels_), mask);
  });
  sum_up(covered_before_);
}

Coverage::Coverage(std::uint64_t pixels, const std::byte* encoded)
    : pixels_(pixels), covered_before_(groups_of(pixels) + 1) {
  std::uint64_t all = 0;
  encoded = take(encoded, all);
  if (all == 0) return;
  if (all == pixels) {
    for (std::size_t i = 0; i < groups(); ++i) {
      covered_before_[i + 1] = std::min((i + 1) * kGroupPixels, pixels);
    }
    return;
  }
  for (std::size_t i = 0; i < groups(); ++i) {
    std::uint16_t count = 0;
    take(encoded + i * sizeof count, count);
    covered_before_[i + 1] = count;
  }
  sum_up(covered_before_);
  encoded += bytes_of_counts(groups());

  masks_.reset(new GroupMask[groups()]);
  const std::byte* elements = encoded;
  for (std::size_t i = 0; i < groups(); ++i) elements += is_mixed(i) ? sizeof(Blocks) : 0;
  for (std::size_t i = 0; i < groups(); ++i) {
    if (!is_mixed(i)) continue;
    Blocks blocks;
    encoded = take(encoded, blocks);
    const Group at = group(i);
    for (std::size_t k = 0; k < kGroupPixels / 64; ++k) {
      const std::uint64_t bit = std::uint64_t{1} << k;
      masks_[i][k] = (blocks.full & bit) != 0 ? full_element(at.end - at.begin, k) : 0;
      if ((blocks.mixed() & bit) != 0) elements = take(elements, masks_[i][k]);
    }
  }
}

std::size_t Coverage::encoded_bytes() const {
  std::size_t bytes = sizeof(std::uint64_t);
  if (covered() == 0 || covered() == pixels_) return bytes;
  bytes += bytes_of_counts(groups());
  for (std::size_t i = 0; i < groups(); ++i) {
    if (!is_mixed(i)) continue;
    const Group at = group(i);
    const Blocks blocks = blocks_of(masks_[i], at.end - at.begin);
    bytes += sizeof blocks +
             sizeof(std::uint64_t) * static_cast<std::size_t>(std::popcount(blocks.mixed()));
  }
  return bytes;
}

std::byte* Coverage::encode(std::byte* to) const {
  to = put(to, covered());
  if (covered() == 0 || covered() == pixels_) return to;
  std::byte* const end_of_counts = to + bytes_of_counts(groups());
  for (std::size_t i = 0; i < groups(); ++i)
    to = put(to, static_cast<std::uint16_t>(group(i).covered));
  std::fill(to, end_of_counts, std::byte{0});
  to = end_of_counts;

  std::byte* elements = to;
  for (std::size_t i = 0; i < groups(); ++i) elements += is_mixed(i) ? sizeof(Blocks) : 0;
  for (std::size_t i = 0; i < groups(); ++i) {
    if (!is_mixed(i)) continue;
    const Group at = group(i);
    const Blocks blocks = blocks_of(masks_[i], at.end - at.begin);
    to = put(to, blocks);
    for (std::uint64_t mixed = blocks.mixed(); mixed != 0; mixed &= mixed - 1) {
      elements = put(elements, masks_[i][static_cast<std::size_t>(std::countr_zero(mixed))]);
    }
  }
  return elements;
}

}  // namespace delray::composite
