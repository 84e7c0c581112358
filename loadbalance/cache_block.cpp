// Asks the system for the cache, and rounds the root of what fits down to whole lines.
#include "loadbalance/cache_block.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>

namespace delray::loadbalance {

CacheSize first_level_cache() {
  CacheSize cache;
#ifdef _SC_LEVEL1_DCACHE_SIZE
  if (const long bytes = sysconf(_SC_LEVEL1_DCACHE_SIZE); bytes > 0)
    cache.bytes = static_cast<std::size_t>(bytes);
  if (const long line = sysconf(_SC_LEVEL1_DCACHE_LINESIZE); line > 0)
    cache.line = static_cast<std::size_t>(line);
#endif
  return cache;
}

int cache_block_side(const CacheSize& cache, std::size_t pixel_bytes, std::size_t plane_bytes) {
  const std::size_t line_pixels = std::max<std::size_t>(1, cache.line / plane_bytes);
  const auto side = static_cast<std::size_t>(
      std::sqrt(static_cast<double>(cache.bytes) / static_cast<double>(pixel_bytes)));
  return static_cast<int>(std::max(line_pixels, side / line_pixels * line_pixels));
}

}  // namespace delray::loadbalance
