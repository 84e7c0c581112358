// Parallel radix sort from the lowest digit up (Zagha and Blelloch 1991): each block counts its
// digits, a prefix sum over digits and blocks gives every block its places, and each block moves
// its own entries. O(n). Digits in which all entries agree are skipped, few entries are sorted by
// comparison.
#include "delaunay/order/radix_sort.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace delray::delaunay::internal {
namespace {

constexpr int kLowestBit = 32, kBits = 32;

template <int DigitBits>
void sort_by_digits(Array<std::uint64_t>& entries, const Blocks& blocks) {
  constexpr std::size_t kValues = std::size_t{1} << DigitBits;
  const std::size_t n = entries.size();
  Array<std::uint64_t> other(n);
  // Per block and digit: how many entries there are, then where the next one goes.
  std::vector<std::array<std::uint32_t, kValues>> places(blocks.count());
  for (int shift = kLowestBit; shift < kLowestBit + kBits; shift += DigitBits) {
    const auto digit = [shift](std::uint64_t entry) { return (entry >> shift) & (kValues - 1); };
    blocks.for_each([&](std::size_t block, std::size_t first, std::size_t last) {
      auto& count = places[block];
      count.fill(0);
      for (std::size_t i = first; i < last; ++i) ++count[digit(entries[i])];
    });
    std::uint32_t place = 0;
    bool all_equal = false;
    for (std::size_t value = 0; value < kValues; ++value) {
      const std::uint32_t start = place;
      for (auto& count : places) place += std::exchange(count[value], place);
      all_equal |= place - start == n;
    }
    if (all_equal) continue;
    blocks.for_each([&](std::size_t block, std::size_t first, std::size_t last) {
      auto& next = places[block];
      for (std::size_t i = first; i < last; ++i) other[next[digit(entries[i])]++] = entries[i];
    });
    std::swap(entries, other);
  }
}

}  // namespace

void radix_sort(Array<std::uint64_t>& entries, const Blocks& blocks) {
  // Up to these sizes comparing, or counting fewer values in more passes, is faster.
  constexpr std::size_t kComparing = 256, kShortDigits = 16384;
  const auto upper_half_less = [](std::uint64_t a, std::uint64_t b) {
    return a >> kLowestBit < b >> kLowestBit;
  };
  if (entries.size() < kComparing) {
    std::stable_sort(entries.data(), entries.data() + entries.size(), upper_half_less);
  } else if (entries.size() < kShortDigits) {
    sort_by_digits<8>(entries, blocks);
  } else {
    sort_by_digits<11>(entries, blocks);
  }
}

}  // namespace delray::delaunay::internal
