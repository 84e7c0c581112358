// Blocks of the size of a processor's cache.
#pragma once

#include <cstddef>

namespace delray::loadbalance {

// Bytes of a cache.
struct CacheSize {
  std::size_t bytes = std::size_t{32} << 10;
  std::size_t line = 64;
};

// The first-level data cache of this processor; that of CacheSize where the system does not tell.
CacheSize first_level_cache();

// The side in pixels of the largest square block whose pixels, of so many bytes each, fit the
// cache, every row a whole number of cache lines in each plane whose values take `plane_bytes` or
// more: tasks are multiples of the cache's granularity, so that no two processors write to one line
// (Utah: Parker et al. 1999). At least one line. REQUIRES: no argument is 0.
int cache_block_side(const CacheSize& cache, std::size_t pixel_bytes, std::size_t plane_bytes);

}  // namespace delray::loadbalance
