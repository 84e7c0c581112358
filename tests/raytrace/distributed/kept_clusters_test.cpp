// What stays in a cache that is too small: a worked example, ties, and the laws of the choice.
#include "raytrace/distributed/kept_clusters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace delray::raytrace {
namespace {

using Chosen = std::vector<std::uint32_t>;

TEST(KeptClusters, TakesWhatMostRaysMeetForEachByte) {
  // 10, 5, 30 and 20 rays a byte.
  const std::vector<MetCluster> met = {{7, 100, 10}, {8, 500, 100}, {9, 900, 30}, {2, 400, 20}};
  EXPECT_EQ(choose_kept(met, 60), (Chosen{9, 2, 7}));
  EXPECT_EQ(choose_kept(met, 160), (Chosen{9, 2, 7, 8}));
  EXPECT_EQ(choose_kept(met, 49), (Chosen{9, 7})) << "what does not fit is passed over";
}

TEST(KeptClusters, MakesWayOnlyForWhatIsMuchMoreInDemand) {
  EXPECT_EQ(choose_kept({{0, 10, 1, true}, {1, 15, 1, false}}, 1), Chosen{0});
  EXPECT_EQ(choose_kept({{0, 10, 1, true}, {1, 25, 1, false}}, 1), Chosen{1});
}

TEST(KeptClusters, KeepsNothingThatNoRayMetOrThatHasNoRoom) {
  EXPECT_EQ(choose_kept({}, 100), Chosen{});
  EXPECT_EQ(choose_kept({{3, 0.0, 10}, {4, 5.0, 10}}, 100), Chosen{4});
  EXPECT_EQ(choose_kept({{3, 1.0, 10}}, 0), Chosen{});
  EXPECT_EQ(choose_kept({{5, 2.0, 8}, {3, 2.0, 8}}, 8), Chosen{3}) << "ties by number";
}

TEST(KeptClusters, RandomChoicesFitAndLeaveRoomForNothingMoreInDemand) {
  std::random_device device;
  const unsigned seed = device();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  for (int round = 0; round < 200; ++round) {
    std::vector<MetCluster> met;
    for (std::uint32_t i = 0; i < random() % 60; ++i)
      met.push_back({i, static_cast<double>(random() % 100), 1 + random() % 50, random() % 4 == 0});
    const std::uint64_t room = random() % 1000;
    const Chosen chosen = choose_kept(met, room);
    std::shuffle(met.begin(), met.end(), random);
    EXPECT_EQ(choose_kept(met, room), chosen) << "whatever the order";
    std::sort(met.begin(), met.end(),
              [](const MetCluster& a, const MetCluster& b) { return a.cluster < b.cluster; });
    const auto demand = [&](const MetCluster& m) {
      return (m.kept ? 2.0 : 1.0) * m.rays / static_cast<double>(m.bytes);
    };
    std::uint64_t taken = 0;
    for (const std::uint32_t i : chosen) taken += met[i].bytes;
    ASSERT_LE(taken, room);
    for (const MetCluster& left : met) {
      if (left.rays == 0.0 || std::count(chosen.begin(), chosen.end(), left.cluster) > 0) continue;
      // It does not fit beside those that are as much in demand.
      std::uint64_t before = 0;
      for (const std::uint32_t i : chosen)
        if (demand(met[i]) >= demand(left)) before += met[i].bytes;
      EXPECT_GT(before + left.bytes, room) << left.cluster;
    }
  }
}

}  // namespace
}  // namespace delray::raytrace
