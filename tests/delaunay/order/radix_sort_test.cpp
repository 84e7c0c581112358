// Radix sort is stable and sorts by upper halves; blocks cover all indices.
#include "delaunay/order/radix_sort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "parallel/arena.h"

namespace delray::delaunay::internal {
namespace {

// Entries whose lower halves tell where they were.
std::vector<std::uint64_t> random_entries(std::size_t n, std::uint32_t mask) {
  std::mt19937 random(7);
  std::vector<std::uint64_t> entries(n);
  for (std::size_t i = 0; i < n; ++i) entries[i] = std::uint64_t{random() & mask} << 32 | i;
  return entries;
}

TEST(RadixSort, OrdersUpperHalvesAndKeepsTheOrderOfEqualOnes) {
  for (const int threads : {1, 3}) {
    parallel::Arena arena(threads);
    for (const std::uint32_t mask : {0xffffffffU, 0x00f0000fU, 0xff000000U, 0U}) {
      for (const std::size_t n : {0, 1, 2, 255, 256, 3000, 16383, 16384, 70000}) {
        std::vector<std::uint64_t> expected = random_entries(n, mask);
        Array<std::uint64_t> entries(n);
        std::copy_n(expected.data(), n, entries.data());
        arena.execute([&] { radix_sort(entries, Blocks(n, threads)); });
        std::sort(expected.begin(), expected.end());  // lower halves are in order and different
        EXPECT_TRUE(std::equal(expected.begin(), expected.end(), entries.data()))
            << n << " entries, mask " << mask << ", " << threads << " threads";
      }
    }
  }
}

TEST(Blocks, CoverEveryIndexOnce) {
  for (const int threads : {1, 2, 3, 8}) {
    parallel::Arena arena(threads);
    for (const std::size_t n : {0, 1, 8191, 16384, 50001, 1000003}) {
      const Blocks blocks(n, threads);
      std::vector<int> calls(n, 0);
      arena.execute([&] {
        blocks.for_each([&](std::size_t block, std::size_t first, std::size_t last) {
          EXPECT_LT(block, blocks.count());
          for (std::size_t i = first; i < last; ++i) ++calls[i];
        });
      });
      EXPECT_EQ(std::count(calls.begin(), calls.end(), 1), static_cast<std::ptrdiff_t>(n));
    }
  }
}

}  // namespace
}  // namespace delray::delaunay::internal
