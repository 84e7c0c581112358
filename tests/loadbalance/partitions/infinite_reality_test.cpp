// Fine interlaced regions: whatever is shown, every part has an equal share of it.
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "loadbalance/partition.h"
#include "loadbalance/partitions/partitioners.h"

namespace delray::loadbalance {
namespace {

// `box` is all that costs something.
std::vector<double> shares_of(geometry::Rect frame, geometry::Rect box, int parts) {
  const Costs costs = make_costs(frame, 32, 32, {});
  const Partition partition = find_partitioner("infinite-reality")->partition(costs, frame, parts);
  std::vector<double> shares(static_cast<std::size_t>(parts));
  for (const Region& region : partition.regions) {
    EXPECT_LE(region.rect.width(), internal::kInfiniteRealitySide);
    shares[static_cast<std::size_t>(region.owner)] +=
        static_cast<double>(geometry::intersection(region.rect, box).area());
  }
  return shares;
}

TEST(InfiniteReality, SharesOutWhateverIsShown) {
  const unsigned seed = std::random_device()();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  for (int i = 0; i < 20; ++i) {
    const int x = static_cast<int>(random() % 500), y = static_cast<int>(random() % 300);
    const geometry::Rect box{x, y, x + 400, y + 300};
    for (const int parts : {2, 3, 8})
      EXPECT_LT(imbalance(shares_of({0, 0, 1280, 720}, box, parts)), 1.2);
  }
}

TEST(InfiniteReality, GetsFinerWhereThereAreManyParts) {
  const geometry::Rect frame{0, 0, 64, 64};
  for (const double share : shares_of(frame, frame, 64)) EXPECT_NEAR(share, 64, 8);
}

}  // namespace
}  // namespace delray::loadbalance
