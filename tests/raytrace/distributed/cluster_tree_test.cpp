// The tree of clusters against a plain search of all boxes, on random and degenerate boxes.
#include "raytrace/distributed/cluster_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

namespace delray::raytrace {
namespace {

constexpr ClusterHit kBegin{-1.0F, 0};

// Where the line enters the box, as the tree counts it; what it misses it does not enter.
bool enters(const geometry::Box3& box, const Line& line, float& entry) {
  float low = line.near, high = line.far;
  for (int k = 0; k < 3; ++k) {
    const float a = (box.low[k] - line.origin[k]) * line.inverse[k];
    const float b = (box.high[k] - line.origin[k]) * line.inverse[k];
    if (a != a || b != b) continue;
    const float first = std::min(a, b), last = std::max(a, b);
    low = std::max(low, first > 0 ? first * (1 - 0x1p-20F) : first * (1 + 0x1p-20F));
    high = std::min(high, last > 0 ? last * (1 + 0x1p-20F) : last * (1 - 0x1p-20F));
  }
  entry = low;
  return low <= high;
}

std::vector<ClusterHit> all_hits(const std::vector<ClusterBox>& boxes, const Line& line) {
  std::vector<ClusterHit> hits;
  for (const ClusterBox& box : boxes) {
    float entry = 0;
    if (enters(box.box, line, entry)) hits.push_back({entry, box.cluster});
  }
  std::sort(hits.begin(), hits.end());
  hits.erase(std::unique(hits.begin(), hits.end()), hits.end());
  return hits;
}

std::vector<ClusterHit> hits_one_by_one(const ClusterTree& tree, const Line& line) {
  std::vector<ClusterHit> hits;
  for (ClusterHit hit = tree.next(line, kBegin); hit.cluster != kNoCluster;
       hit = tree.next(line, hit))
    hits.push_back(hit);
  return hits;
}

Line line_from(const glm::vec3& origin, const glm::vec3& direction, float near, float far) {
  return {origin, glm::vec3(1.0F) / direction, near, far};
}

class RandomBoxes : public testing::TestWithParam<std::size_t> {};

// Coordinates are small integers half of the time: boxes then touch, coincide and are flat, and
// lines run in their sides.
TEST_P(RandomBoxes, AreMetInOrderEachOnce) {
  std::random_device device;
  const unsigned seed = device();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> anywhere(-4.0F, 4.0F);
  std::uniform_int_distribution<int> on_grid(-2, 2);
  std::size_t met = 0;
  for (int round = 0; round < 60; ++round) {
    const bool grid = round % 2 == 0;
    const auto number = [&] {
      return grid ? static_cast<float>(on_grid(random)) : anywhere(random);
    };
    const auto vector = [&] {
      const float x = number(), y = number(), z = number();
      return glm::vec3(x, y, z);
    };
    std::vector<ClusterBox> boxes(GetParam());
    for (ClusterBox& box : boxes) {
      const glm::vec3 corner = vector();
      box.box.include(corner);
      box.box.include(corner + vector() * 0.4F);
      // Some clusters are placed several times.
      box.cluster = std::uniform_int_distribution<std::uint32_t>(
          0, static_cast<std::uint32_t>(boxes.size()))(random);
    }
    const ClusterTree tree(boxes);
    for (int i = 0; i < 40; ++i) {
      const Line line = line_from(vector(), vector(), 0.0F, i % 3 == 0 ? 0.7F : 1e30F);
      const std::vector<ClusterHit> expected = all_hits(boxes, line);
      ASSERT_EQ(hits_one_by_one(tree, line), expected);
      met += expected.size();
    }
  }
  EXPECT_GT(met, 0U);
}
INSTANTIATE_TEST_SUITE_P(Counts, RandomBoxes, testing::Values(1, 2, 7, 8, 9, 64, 65, 300));

TEST(ClusterTree, WithoutBoxesIsMetByNothing) {
  const ClusterTree tree;
  EXPECT_TRUE(tree.empty());
  EXPECT_EQ(tree.next(line_from({}, {1, 1, 1}, 0, 1), kBegin).cluster, kNoCluster);
  EXPECT_EQ(tree.hit_lines({{}, {}, nullptr, nullptr, 0}), 0U);
  EXPECT_TRUE(ClusterTree(std::vector<ClusterBox>{}).empty());
}

// What a box's hit is does not depend on the other boxes: ranks have different trees.
TEST(ClusterTree, FindsTheSameHitsWhateverElseItHolds) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> anywhere(-3.0F, 3.0F);
  const auto vector = [&] {
    const float x = anywhere(random), y = anywhere(random), z = anywhere(random);
    return glm::vec3(x, y, z);
  };
  std::vector<ClusterBox> boxes(100), odd;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    const glm::vec3 corner = vector();
    boxes[i].box.include(corner);
    boxes[i].box.include(corner + vector());
    boxes[i].cluster = i;
    if (i % 2 != 0) odd.push_back(boxes[i]);
  }
  const ClusterTree all(boxes), some(odd);
  for (int i = 0; i < 200; ++i) {
    const Line line = line_from(vector(), vector(), 0.0F, 1e30F);
    std::vector<ClusterHit> expected = hits_one_by_one(all, line);
    std::erase_if(expected, [](const ClusterHit& hit) { return hit.cluster % 2 == 0; });
    EXPECT_EQ(hits_one_by_one(some, line), expected);
  }
}

struct Lines {
  float origin[3][LinePacket::kLines], direction[3][LinePacket::kLines];
  float near[LinePacket::kLines], far[LinePacket::kLines];
  std::uint32_t active = 0;

  LinePacket packet() const {
    return {{origin[0], origin[1], origin[2]},
            {direction[0], direction[1], direction[2]},
            near,
            far,
            active};
  }
  Line line(int i) const {
    return line_from({origin[0][i], origin[1][i], origin[2][i]},
                     {direction[0][i], direction[1][i], direction[2][i]}, near[i], far[i]);
  }
};

// Lines side by side have a hit where each has one by itself, whether they are close to each other
// or not. Some go along axes, or start in sides.
TEST_P(RandomBoxes, AreMetByLinesSideBySideAsByEachAlone) {
  std::mt19937 random(static_cast<unsigned>(GetParam()));
  std::uniform_real_distribution<float> anywhere(-4.0F, 4.0F), little(0.0F, 1.0F);
  std::vector<ClusterBox> boxes(GetParam());
  const float size = boxes.size() < 64 ? 2.0F : 0.4F;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    const glm::vec3 corner(anywhere(random), anywhere(random), std::round(anywhere(random)));
    boxes[i].box.include(corner);
    boxes[i].box.include(corner + glm::vec3(little(random), little(random), 0.3F) * size);
    boxes[i].cluster = i;
  }
  const ClusterTree tree(boxes);
  int some = 0, none = 0;
  for (int round = 0; round < 2000; ++round) {
    Lines lines{};
    lines.active = round % 3 == 0 ? 0xFFFFU : static_cast<std::uint32_t>(random() & 0xFFFFU);
    const float wide = round % 5 == 0 ? 3.0F : 0.001F;
    for (int k = 0; k < 3; ++k) {
      const float origin = round % 7 == 0 ? std::round(anywhere(random)) : anywhere(random);
      const float direction = round % 11 == 0 && k == 1 ? 0.0F : anywhere(random);
      for (int i = 0; i < LinePacket::kLines; ++i) {
        const bool counts = (lines.active >> i & 1) != 0;
        lines.origin[k][i] = counts ? origin + wide * little(random) : 100.0F * anywhere(random);
        lines.direction[k][i] = direction + (direction != 0.0F ? wide * little(random) : 0.0F);
        lines.near[i] = 0.0F;
        lines.far[i] = round % 2 == 0 ? 0.5F + little(random) : 1e30F;
      }
    }
    std::uint32_t expected = 0;
    for (int i = 0; i < LinePacket::kLines; ++i) {
      const bool counts = (lines.active >> i & 1) != 0;
      if (counts && tree.next(lines.line(i), kBegin).cluster != kNoCluster) expected |= 1U << i;
    }
    ASSERT_EQ(tree.hit_lines(lines.packet()), expected) << round;
    (expected != 0 ? some : none) += 1;
  }
  EXPECT_GT(some, 0);
  EXPECT_GT(none, 0);
}

}  // namespace
}  // namespace delray::raytrace
