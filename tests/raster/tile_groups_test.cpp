#include "raster/internal/tile_groups.h"

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <random>
#include <set>

namespace delray::raster {
namespace {

TEST(TileGroups, NumberEveryTriangleOnce) {
  const auto groups = std::make_unique<TileGroups>();
  std::mt19937 random(5);
  for (int round = 0; round < 200; ++round) {
    groups->clear();
    // From a few clusters to one per triangle, near each other and far apart.
    const std::uint32_t reach = 1U << (random() % 32);
    std::map<std::uint32_t, std::uint16_t> group_of;
    const std::size_t additions = random() % (round % 10 == 0 ? 8000 : 300);
    while (group_of.size() < std::min<std::size_t>(additions, reach) &&
           group_of.size() < kTilePixels) {
      const std::uint32_t number = 77 + static_cast<std::uint32_t>(random()) % reach;
      const std::uint16_t group = groups->add(number);
      const auto [place, added] = group_of.emplace(number, group);
      ASSERT_EQ(place->second, group);
    }
    groups->number_triangles();
    ASSERT_EQ(groups->places().size(), group_of.size());
    std::set<std::uint16_t> indices;
    for (const auto& [number, group] : group_of) {
      const std::uint16_t index = groups->index(group, number);
      const TileGroups::Group& its = groups->groups()[group];
      ASSERT_EQ(its.cluster, number >> kClusterBits);
      ASSERT_GE(index, its.first);
      ASSERT_LT(index, its.first + its.count);
      ASSERT_EQ(groups->places()[index], number % kClusterTriangles);
      ASSERT_TRUE(indices.insert(index).second);
    }
  }
}

}  // namespace
}  // namespace delray::raster
