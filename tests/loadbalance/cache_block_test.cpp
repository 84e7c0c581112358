#include "loadbalance/cache_block.h"

#include <gtest/gtest.h>

namespace delray::loadbalance {
namespace {

// As many whole lines as fit, and never less than one.
TEST(CacheBlock, FitsTheCacheInWholeLines) {
  for (const std::size_t bytes : {4096U, 32768U, 49152U, 65536U}) {
    for (const std::size_t line : {32U, 64U, 128U}) {
      const int side = cache_block_side({bytes, line}, 20, 4);
      const int line_pixels = static_cast<int>(line / 4);
      EXPECT_EQ(side % line_pixels, 0) << bytes << ' ' << line;
      const int more = side + line_pixels;
      if (side > line_pixels) {
        EXPECT_LE(static_cast<std::size_t>(side * side) * 20, bytes);
      }
      EXPECT_GT(static_cast<std::size_t>(more * more) * 20, bytes);
    }
  }
  EXPECT_EQ(cache_block_side({32768, 64}, 20, 4), 32);
  EXPECT_EQ(cache_block_side({16, 64}, 20, 4), 16);
}

TEST(CacheBlock, OfThisProcessorHasALine) {
  const CacheSize cache = first_level_cache();
  EXPECT_GE(cache.bytes, cache.line);
  EXPECT_GT(cache.line, 0U);
}

}  // namespace
}  // namespace delray::loadbalance
