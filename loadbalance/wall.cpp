// Cuts the frame along bezels, and counts the pixels that go from who draws them to who shows them.
#include "loadbalance/wall.h"

#include <algorithm>
#include <cassert>
#include <set>

#include "loadbalance/region_index.h"

namespace delray::loadbalance {
namespace {

// The ends of the parts of an axis, from where each display ends and the next begins.
std::vector<int> middles(const std::set<int>& begins, const std::set<int>& ends, int first,
                         int last) {
  std::vector<int> cuts = {first};
  for (const int begin : begins) {
    const auto before = ends.upper_bound(begin);
    if (before == ends.begin()) continue;  // nothing lies before it
    cuts.push_back((*std::prev(before) + begin + 1) / 2);
  }
  cuts.push_back(last);
  return cuts;
}

}  // namespace

std::vector<Region> displays_of(const Wall& wall, int ranks) {
  assert(ranks >= 1);
  std::vector<Region> displays;
  for (int i = 0; i < wall.displays(); ++i) {
    const std::int64_t owner = std::int64_t{i} * ranks / wall.displays();
    displays.push_back({wall.display(i), static_cast<int>(owner)});
  }
  return displays;
}

Partition cut_by_displays(const geometry::Rect& frame, std::span<const Region> displays) {
  std::set<int> left, right, top, bottom;
  for (const Region& display : displays) {
    left.insert(display.rect.x0);
    right.insert(display.rect.x1);
    top.insert(display.rect.y0);
    bottom.insert(display.rect.y1);
  }
  const std::vector<int> x = middles(left, right, frame.x0, frame.x1);
  const std::vector<int> y = middles(top, bottom, frame.y0, frame.y1);
  const auto part = [](const std::vector<int>& cuts, int begin) {
    return static_cast<std::size_t>(std::ranges::upper_bound(cuts, begin) - cuts.begin()) - 1;
  };
  Partition partition{frame, {}};
  for (const Region& display : displays) {
    const std::size_t i = part(x, display.rect.x0), j = part(y, display.rect.y0);
    partition.regions.push_back({{x[i], y[j], x[i + 1], y[j + 1]}, display.owner});
  }
  return partition;
}

PixelTraffic pixel_traffic(const Partition& partition, std::span<const Region> displays,
                           int ranks) {
  const Partition shown{partition.frame, {displays.begin(), displays.end()}};
  const RegionIndex index(shown);
  std::vector<std::uint64_t> moved(static_cast<std::size_t>(ranks));
  PixelTraffic traffic;
  for (const Region& region : partition.regions) {
    index.for_each_region(region.rect, [&](const Region& display, const geometry::Rect& common) {
      if (display.owner == region.owner) return;
      const auto pixels = static_cast<std::uint64_t>(common.area());
      traffic.pixels += pixels;
      moved[static_cast<std::size_t>(region.owner)] += pixels;
      moved[static_cast<std::size_t>(display.owner)] += pixels;
    });
  }
  traffic.busiest = *std::ranges::max_element(moved);
  return traffic;
}

}  // namespace delray::loadbalance
