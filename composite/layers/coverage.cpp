// Finds which pixels of a range are covered, and encodes it in levels: a count for the range, a
// count for each group, two bits for each block of 64 pixels in groups that are mixed, and a mask
// for each block that is mixed itself.
//
// Degenerate: a range covered by all or by none of its pixels is the first count alone, eight
// bytes. A message whose counts, masks and length contradict each other is refused.
#include "composite/coverage.h"

#include <cstring>

#include "comm/bad_message.h"
#include "parallel/parallel_for.h"

namespace delray::composite {
namespace {

using comm::check_message;

// The element of a mask that has all bits of a group of `size` pixels.
std::uint64_t full_element(std::uint64_t size, std::size_t i) {
  const std::uint64_t begin = i * 64;
  if (size >= begin + 64) return ~std::uint64_t{0};
  return size > begin ? (std::uint64_t{1} << (size - begin)) - 1 : 0;
}

// As Coverage::Blocks has them, of a group of `size` pixels.
template <class Blocks>
Blocks blocks_of(const GroupMask& mask, std::uint64_t size) {
  Blocks result;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    result.any |= std::uint64_t{mask[i] != 0} << i;
    result.full |= std::uint64_t{~mask[i] == 0} << i;
  }
  if (const std::uint64_t rest = size % 64; rest != 0) {
    const std::size_t last = size / 64;
    result.full |= std::uint64_t{mask[last] == full_element(size, last)} << last;
  }
  return result;
}

// Calls f(i) for every bit i that is set.
template <class F>
void for_each_bit(std::uint64_t bits, F&& f) {
  for (; bits != 0; bits &= bits - 1) f(static_cast<std::size_t>(std::countr_zero(bits)));
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
    : pixels_(pixels),
      covered_before_(groups_of(pixels) + 1),
      masks_(new GroupMask[groups()]),
      blocks_(groups()) {
  parallel::parallel_for(0, groups(), 1, [&](std::size_t i) {
    GroupMask& mask = masks_[i];
    mask.fill(0);
    covered_before_[i + 1] =
        find(i * kGroupPixels, std::min((i + 1) * kGroupPixels, pixels_), mask);
    blocks_[i] = blocks_of<Blocks>(mask, group_size(i));
  });
  sum_up(covered_before_);
  if (covered() == 0 || covered() == pixels_) return;
  encoded_bytes_ += bytes_of_counts(groups());
  for (std::size_t i = 0; i < groups(); ++i) {
    if (!is_mixed(i)) continue;
    encoded_bytes_ +=
        sizeof(Blocks) +
        sizeof(std::uint64_t) * static_cast<std::size_t>(std::popcount(blocks_[i].mixed()));
  }
}

Coverage::Coverage(std::uint64_t pixels, std::span<const std::byte> message)
    : pixels_(pixels), covered_before_(groups_of(pixels) + 1) {
  const std::byte* const end = message.data() + message.size();
  const std::byte* encoded = message.data();
  const auto require = [&](const std::byte* from, std::size_t bytes) {
    check_message(static_cast<std::size_t>(end - from) >= bytes);
  };
  std::uint64_t all = 0;
  require(encoded, sizeof all);
  encoded = take(encoded, all);
  if (all == 0) return;
  if (all == pixels) {
    for (std::size_t i = 0; i < groups(); ++i) {
      covered_before_[i + 1] = std::min((i + 1) * kGroupPixels, pixels);
    }
    return;
  }
  require(encoded, bytes_of_counts(groups()));
  for (std::size_t i = 0; i < groups(); ++i) {
    std::uint16_t count = 0;
    take(encoded + i * sizeof count, count);
    check_message(count <= group_size(i));
    covered_before_[i + 1] = count;
  }
  sum_up(covered_before_);
  check_message(covered() == all);
  encoded += bytes_of_counts(groups());

  masks_.reset(new GroupMask[groups()]);
  blocks_.resize(groups());
  std::size_t mixed = 0;
  for (std::size_t i = 0; i < groups(); ++i) mixed += is_mixed(i) ? 1 : 0;
  require(encoded, mixed * sizeof(Blocks));
  const std::byte* elements = encoded + mixed * sizeof(Blocks);
  for (std::size_t i = 0; i < groups(); ++i) {
    if (!is_mixed(i)) continue;
    Blocks& blocks = blocks_[i];
    encoded = take(encoded, blocks);
    const std::uint64_t size = group_size(i);
    GroupMask& mask = masks_[i];
    mask.fill(0);
    std::uint64_t set = 0;
    const auto count = [&](std::size_t k) {
      check_message((mask[k] & ~full_element(size, k)) == 0);
      set += static_cast<std::uint64_t>(std::popcount(mask[k]));
    };
    for_each_bit(blocks.full, [&](std::size_t k) {
      mask[k] = full_element(size, k);
      count(k);
    });
    require(elements,
            sizeof(std::uint64_t) * static_cast<std::size_t>(std::popcount(blocks.mixed())));
    for_each_bit(blocks.mixed(), [&](std::size_t k) {
      elements = take(elements, mask[k]);
      count(k);
    });
    check_message(set == group(i).covered);
  }
  encoded_bytes_ = static_cast<std::size_t>(elements - message.data());
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
    to = put(to, blocks_[i]);
    for_each_bit(blocks_[i].mixed(),
                 [&](std::size_t k) { elements = put(elements, masks_[i][k]); });
  }
  return elements;
}

}  // namespace delray::composite
