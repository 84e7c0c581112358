// The index finds each region of a box once.
#include "loadbalance/region_index.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "tests/loadbalance/boxes.h"

namespace delray::loadbalance {
namespace {

using geometry::Rect;

TEST(RegionIndex, FindsEachRegionOfABoxOnce) {
  const Rect frame{-20, 10, 200, 130};
  const auto content = testing::boxes(testing::Scenery::clusters, frame, 300, 1);
  const Costs costs = testing::costs_of(frame, 4, content);
  std::mt19937 random(4);
  const auto number = [&](int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(random);
  };
  for (const Partitioner& partitioner : partitioners()) {
    const Partition partition = partitioner.partition(costs, frame, number(1, 40));
    const RegionIndex index(partition);
    for (int k = 0; k < 50; ++k) {
      const int x = number(-60, 210), y = number(-20, 150);
      const Rect box{x, y, x + number(0, 100), y + number(0, 100)};
      std::multiset<const Region*> found;
      std::set<const Region*> expected;
      std::set<int> owners;
      std::int64_t pixels = 0;
      index.for_each_region(box, [&](const Region& region, const Rect& common) {
        found.insert(&region);
        EXPECT_EQ(common, geometry::intersection(region.rect, box));
        pixels += common.area();
      });
      for (const Region& region : partition.regions) {
        if (geometry::intersection(region.rect, box).empty()) continue;
        expected.insert(&region);
        owners.insert(region.owner);
      }
      ASSERT_TRUE(std::equal(found.begin(), found.end(), expected.begin(), expected.end()))
          << partitioner.name;
      EXPECT_EQ(pixels, geometry::intersection(frame, box).area());
      std::vector<int> listed = {99};
      index.owners_of(box, listed);
      EXPECT_TRUE(std::equal(listed.begin(), listed.end(), owners.begin(), owners.end()));
    }
  }
}

TEST(RegionIndex, OfEmptyPartitions) {
  for (const Rect frame : {Rect{}, Rect{3, 3, 9, 9}}) {
    const Partition partition{frame, {}};
    RegionIndex(partition).for_each_region({0, 0, 5, 5},
                                           [](const Region&, const Rect&) { FAIL(); });
  }
}

}  // namespace
}  // namespace delray::loadbalance
