// An array by vertex finds the least corner of each, by any threads in any order; first corners are
// counted block by block, and numbered from the counts before.
#include "scenes/geometry/number_by_use.h"

#include <algorithm>
#include <atomic>
#include <numeric>

#include "parallel/parallel_for.h"

namespace delray::scenes::internal {

std::size_t number_by_first_corner(std::span<glm::uvec3> triangles,
                                   std::vector<std::uint32_t>& number) {
  constexpr std::size_t kBlock = 1 << 14;  // triangles: some ten microseconds
  parallel::parallel_for(0, triangles.size(), kBlock, [&](std::size_t t) {
    for (int k = 0; k < 3; ++k) {
      const auto corner = static_cast<std::uint32_t>(3 * t) + static_cast<std::uint32_t>(k);
      std::atomic_ref<std::uint32_t> first(number[triangles[t][k]]);
      std::uint32_t held = first.load(std::memory_order_relaxed);
      while (corner < held &&
             !first.compare_exchange_weak(held, corner, std::memory_order_relaxed)) {
      }
    }
  });
  // How many first corners there are before each block. A vertex that has its new number, which is
  // below its first corner, is nobody's first any more.
  const std::size_t count = triangles.size(), blocks = (count + kBlock - 1) / kBlock;
  std::vector<std::uint32_t> before(blocks + 1, 0);
  const auto for_first_corners = [&](std::size_t block, auto&& f) {
    for (std::size_t t = block * kBlock; t < std::min(count, (block + 1) * kBlock); ++t) {
      for (int k = 0; k < 3; ++k) {
        std::atomic_ref<std::uint32_t> first(number[triangles[t][k]]);
        if (first.load(std::memory_order_relaxed) == 3 * t + static_cast<std::size_t>(k)) f(first);
      }
    }
  };
  parallel::parallel_for(0, blocks, 1, [&](std::size_t b) {
    std::uint32_t firsts = 0;
    for_first_corners(b, [&](auto&) { ++firsts; });
    before[b + 1] = firsts;
  });
  std::partial_sum(before.begin(), before.end(), before.begin());
  parallel::parallel_for(0, blocks, 1, [&](std::size_t b) {
    std::uint32_t next = before[b];
    for_first_corners(b, [&](auto& first) { first.store(next++, std::memory_order_relaxed); });
  });
  parallel::parallel_for(0, count, kBlock, [&](std::size_t t) {
    for (int k = 0; k < 3; ++k) triangles[t][k] = number[triangles[t][k]];
  });
  return before.back();
}

}  // namespace delray::scenes::internal
