#include "raster/shading/tile_groups.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <set>
#include <vector>

namespace delray::raster {
namespace {

TEST(TileGroups, NumberEveryTriangleOnce) {
  const auto groups = std::make_unique<TileGroups>();
  std::mt19937 random(5);
  for (int round = 0; round < 200; ++round) {
    groups->clear();
    // From a few clusters to one per triangle, near each other and far apart.
    const std::uint32_t reach = 1U << (random() % 32);
    std::set<std::uint32_t> added;
    const std::size_t additions = random() % (round % 10 == 0 ? 8000 : 300);
    while (added.size() < std::min<std::size_t>(additions, reach) && added.size() < kTilePixels) {
      const std::uint32_t number = 77 + static_cast<std::uint32_t>(random()) % reach;
      groups->add(number);
      added.insert(number);
    }
    groups->number_triangles();
    ASSERT_EQ(groups->places().size(), added.size());
    // Every index belongs to one group, and that to one cluster.
    std::vector<std::uint32_t> cluster_of(added.size(), kNothing);
    std::set<std::uint32_t> clusters;
    for (const TileGroups::Group& group : groups->groups()) {
      ASSERT_TRUE(clusters.insert(group.cluster).second);
      for (std::size_t i = group.first; i < std::size_t{group.first} + group.count; ++i) {
        ASSERT_EQ(cluster_of.at(i), kNothing);
        cluster_of[i] = group.cluster;
      }
    }
    std::set<std::uint16_t> indices;
    for (const std::uint32_t number : added) {
      const std::uint16_t index = groups->indices().of(number);
      ASSERT_EQ(cluster_of.at(index), number >> kClusterBits);
      ASSERT_EQ(groups->places()[index], number % kClusterTriangles);
      ASSERT_TRUE(indices.insert(index).second);
    }
  }
}

}  // namespace
}  // namespace delray::raster
