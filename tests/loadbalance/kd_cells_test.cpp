// Cells of a k-d tree: every point once, in order along every ray.
#include "loadbalance/kd_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace delray::loadbalance {
namespace {

using geometry::Box3;

struct Boxes {
  std::vector<Box3> boxes;
  std::vector<std::uint32_t> weights;
};

glm::vec3 random_point(std::mt19937& random, float reach) {
  std::uniform_real_distribution<float> along(-reach, reach);
  return {along(random), along(random), along(random)};
}

// Corners on a coarse lattice, so that centres lie in planes.
Boxes random_boxes(unsigned seed, int n) {
  std::mt19937 random(seed);
  Boxes result;
  for (int i = 0; i < n; ++i) {
    Box3 box;
    for (int corner = 0; corner < 2; ++corner) {
      box.include(glm::floor(random_point(random, 8)));
    }
    result.boxes.push_back(box);
    result.weights.push_back(1 + random() % 5);
  }
  return result;
}

int cell_of(const KdCells& cells, const glm::vec3& p) {
  int found = -1;
  for (std::size_t i = 0; i < cells.cells.size(); ++i) {
    if (!contains(cells.cells[i], p)) continue;
    EXPECT_EQ(found, -1) << "in two cells";
    found = static_cast<int>(i);
  }
  EXPECT_NE(found, -1) << "in none";
  return found;
}

TEST(KdCells, HaveEveryPointOnceAndLieInOrderAlongEveryRay) {
  std::mt19937 random(11);
  for (const int count : {1, 2, 3, 7, 16, 33}) {
    SCOPED_TRACE(count);
    const Boxes boxes = random_boxes(static_cast<unsigned>(count), 200);
    const KdCells cells = cut_space(boxes.boxes, boxes.weights, count);
    ASSERT_EQ(cells.cells.size(), static_cast<std::size_t>(count));
    for (int turn = 0; turn < 50; ++turn) {
      // Every other eye is on planes.
      const glm::vec3 eye =
          turn % 2 == 0 ? random_point(random, 12) : glm::floor(random_point(random, 12)) * 0.5F;
      const glm::vec3 direction =
          turn % 5 == 0 ? glm::vec3(turn % 3 == 0, turn % 3 == 1, 0.5F) : random_point(random, 1);
      const std::vector<int> order = front_to_back(cells, eye);
      std::vector<int> place(order.size());
      for (std::size_t i = 0; i < order.size(); ++i) {
        place[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
      }
      int last = 0;
      for (float along = 0; along < 40; along += 0.03125F) {
        const int at = place[static_cast<std::size_t>(cell_of(cells, eye + direction * along))];
        ASSERT_GE(at, last) << "turn " << turn << " at " << along;
        last = at;
      }
    }
  }
}

TEST(KdCells, ShareTheWeight) {
  Boxes boxes;
  std::mt19937 random(12);
  for (int i = 0; i < 4000; ++i) {
    const glm::vec3 p = random_point(random, 1) * random_point(random, 1);
    boxes.boxes.push_back({p, p});
    boxes.weights.push_back(1 + random() % 9);
  }
  const auto all = std::accumulate(boxes.weights.begin(), boxes.weights.end(), 0U);
  for (const int count : {2, 5, 13}) {
    const KdCells cells = cut_space(boxes.boxes, boxes.weights, count);
    std::vector<std::uint32_t> shares(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < boxes.boxes.size(); ++i) {
      shares[static_cast<std::size_t>(cell_of(cells, boxes.boxes[i].low))] += boxes.weights[i];
    }
    for (const std::uint32_t share : shares) {
      EXPECT_NEAR(share, all / static_cast<unsigned>(count), 9 * 5) << count;
    }
  }
}

TEST(KdCells, TouchTheBoxesThatReachIntoThem) {
  const Boxes boxes = random_boxes(13, 60);
  const KdCells cells = cut_space(boxes.boxes, boxes.weights, 9);
  for (const Box3& box : boxes.boxes) {
    for (const glm::vec3& p : {box.low, box.high, box.centre()}) {
      EXPECT_TRUE(touches(cells.cells[static_cast<std::size_t>(cell_of(cells, p))], box));
    }
  }
  EXPECT_FALSE(touches({{0, 0, 0}, {1, 1, 1}}, {{1, 0, 0}, {2, 1, 1}}));
  EXPECT_TRUE(touches({{0, 0, 0}, {1, 1, 1}}, {{-1, 0, 0}, {0, 1, 1}}));
}

TEST(KdCells, AreThereForNothingAndForWhatIsNowhere) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const Box3 everywhere{glm::vec3(-kInfinity), glm::vec3(kInfinity)};
  const Box3 here{glm::vec3(5), glm::vec3(5)};
  for (const std::vector<Box3>& boxes :
       {std::vector<Box3>{}, {everywhere}, {here}, {here, here, everywhere, here}}) {
    const std::vector<std::uint32_t> weights(boxes.size(), 1);
    for (const int count : {1, 2, 6}) {
      const KdCells cells = cut_space(boxes, weights, count);
      std::vector<int> order = front_to_back(cells, {1, 2, 3});
      std::sort(order.begin(), order.end());
      ASSERT_EQ(order.size(), static_cast<std::size_t>(count));
      for (int i = 0; i < count; ++i) EXPECT_EQ(order[static_cast<std::size_t>(i)], i);
      for (const float x : {-9.0F, 0.0F, 5.0F, 9.0F}) cell_of(cells, {x, x, x});
    }
  }
}

}  // namespace
}  // namespace delray::loadbalance
