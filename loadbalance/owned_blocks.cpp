// Finds the owner of each block by the region that holds its middle pixel, and joins consecutive
// blocks to ranges.
#include "loadbalance/owned_blocks.h"

#include "loadbalance/region_index.h"

namespace delray::loadbalance {

std::vector<TaskRange> owned_blocks(const Partition& partition, const Blocks& blocks, int owner) {
  const RegionIndex index(partition);
  std::vector<TaskRange> owned;
  const std::uint32_t count = blocks.grid().count();
  for (std::uint32_t block = 0; block < count; ++block) {
    const geometry::Rect pixels = blocks.block(block);
    const int x = (pixels.x0 + pixels.x1) / 2, y = (pixels.y0 + pixels.y1) / 2;
    bool is_owned = false;
    index.for_each_region({x, y, x + 1, y + 1}, [&](const Region& region, const geometry::Rect&) {
      is_owned = region.owner == owner;
    });
    if (!is_owned) continue;
    if (!owned.empty() && owned.back().last == block)
      ++owned.back().last;
    else
      owned.push_back({block, block + 1});
  }
  return owned;
}

}  // namespace delray::loadbalance
