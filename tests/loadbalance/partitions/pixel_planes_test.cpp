#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "loadbalance/partition.h"
#include "loadbalance/partitions/partitioners.h"

namespace delray::loadbalance {
namespace {

using geometry::Rect;

// Boxes that are denser towards one corner.
Costs uneven(Rect frame) {
  std::mt19937 random(1);
  std::vector<WeightedBox> boxes;
  for (int i = 0; i < 400; ++i) {
    const int x = frame.x0 + static_cast<int>(random() % static_cast<unsigned>(frame.width()) *
                                              (random() % 100) / 100);
    const int y = frame.y0 + static_cast<int>(random() % static_cast<unsigned>(frame.height()) *
                                              (random() % 100) / 100);
    boxes.push_back(
        {geometry::intersection({x, y, x + 9, y + 5}, frame), 1.0 + random() % 3, 0, 1});
  }
  return make_costs(frame, 64, 48, std::move(boxes));
}

TEST(PixelPlanes, TheCostliestRegionGoesToWhoHasLeast) {
  const Rect frame{0, 0, 1000, 700};
  const Costs costs = uneven(frame);
  for (const int parts : {1, 3, 8, 100}) {
    const Partition partition = internal::pixel_planes(costs, frame, parts);
    // Where there are fewer squares than parts, their sides are halved.
    const int side = parts > 48 ? 64 : 128;
    ASSERT_EQ(partition.regions.size(), parts > 48 ? 16U * 11U : 8U * 6U);
    Partition alone = partition;  // each region by itself
    for (std::size_t i = 0; i < alone.regions.size(); ++i) {
      const Rect& pixels = alone.regions[i].rect;
      EXPECT_EQ(pixels.x0 % side, 0);
      EXPECT_EQ(pixels.y0 % side, 0);
      EXPECT_TRUE(pixels.width() == side || pixels.x1 == frame.x1);
      EXPECT_TRUE(pixels.height() == side || pixels.y1 == frame.y1);
      alone.regions[i].owner = static_cast<int>(i);
    }
    const std::vector<double> load = loads(costs, alone, static_cast<int>(alone.regions.size()));
    std::vector<std::size_t> order(load.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::greater(), [&](std::size_t i) { return load[i]; });
    std::vector<double> owned(static_cast<std::size_t>(parts));
    for (const std::size_t i : order) {
      const auto owner = static_cast<std::size_t>(partition.regions[i].owner);
      EXPECT_EQ(owned[owner], *std::ranges::min_element(owned));
      owned[owner] += load[i];
    }
    const double share = std::accumulate(load.begin(), load.end(), 0.0) / parts;
    EXPECT_LE(*std::ranges::max_element(owned), share + load[order.front()] + 1e-9);
  }
}

}  // namespace
}  // namespace delray::loadbalance
