// Heights of points at one place, merged by each policy.
#include "delaunay/duplicates.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace delray::delaunay {
namespace {

PointCloud example() {
  PointCloud cloud;
  cloud.has_z = true;
  cloud.positions = {{1, 1, 5}, {0.0, 2, 7}, {1, 1, 3}, {-0.0, 2, 7}, {1, 1, 10}, {3, 3, 1}};
  return cloud;
}

TEST(Duplicates, LowestRowGetsTheHeightOfItsPlace) {
  for (const auto& [policy, height] :
       {std::pair{"first", 5.0}, {"min", 3.0}, {"max", 10.0}, {"mean", 6.0}}) {
    PointCloud cloud = example();
    const DuplicatesCount count = merge_duplicates(cloud, duplicates_policy(policy).value());
    EXPECT_EQ(count.places, 1U);  // equal heights are no conflict
    EXPECT_EQ(count.rows, 3U);
    PointCloud expected = example();
    expected.positions[0].z = height;
    EXPECT_EQ(cloud.positions, expected.positions) << policy;
  }
}

TEST(Duplicates, WithoutHeightsNothingHappens) {
  PointCloud cloud = example();
  cloud.has_z = false;
  EXPECT_EQ(merge_duplicates(cloud, Duplicates::max).rows, 0U);
  EXPECT_EQ(cloud.positions, example().positions);
  PointCloud none;
  none.has_z = true;
  EXPECT_EQ(merge_duplicates(none, Duplicates::max).rows, 0U);
}

TEST(Duplicates, MeanOfHugeHeightsDoesNotOverflow) {
  PointCloud cloud;
  cloud.has_z = true;
  cloud.positions = {{0, 0, 1.7e308}, {0, 0, 1.6e308}, {0, 0, 1.7e308}};
  merge_duplicates(cloud, Duplicates::mean);
  EXPECT_GT(cloud.positions[0].z, 1.6e308);
  EXPECT_LT(cloud.positions[0].z, 1.7e308);
}

TEST(Duplicates, AgreesWithAPlainMap) {
  const unsigned seed = 11;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  for (const std::size_t n : {10, 1000, 100000}) {
    PointCloud cloud;
    cloud.has_z = true;
    for (std::size_t i = 0; i < n; ++i) {
      cloud.positions.emplace_back(random() % 64 * 0.125, random() % 64 - 32.0, random() % 4);
    }
    std::map<std::pair<double, double>, std::vector<std::size_t>> places;
    for (std::size_t i = 0; i < n; ++i) {
      places[{cloud.positions[i].x, cloud.positions[i].y}].push_back(i);
    }
    std::vector<glm::dvec3> expected = cloud.positions;
    DuplicatesCount expected_count;
    for (const auto& [place, rows] : places) {
      double low = 9, high = -9;
      for (const std::size_t i : rows) {
        low = std::min(low, cloud.positions[i].z);
        high = std::max(high, cloud.positions[i].z);
      }
      expected[rows[0]].z = low;
      if (low != high) expected_count.rows += rows.size();
      if (low != high) expected_count.places += 1;
    }
    const DuplicatesCount count = merge_duplicates(cloud, Duplicates::min);
    EXPECT_EQ(cloud.positions, expected);
    EXPECT_EQ(count.rows, expected_count.rows);
    EXPECT_EQ(count.places, expected_count.places);
  }
}

TEST(Duplicates, PoliciesAreKnownByName) {
  for (const DuplicatesName& policy : duplicates_policies()) {
    EXPECT_EQ(duplicates_policy(policy.name), policy.policy);
  }
  EXPECT_FALSE(duplicates_policy("median").has_value());
}

}  // namespace
}  // namespace delray::delaunay
