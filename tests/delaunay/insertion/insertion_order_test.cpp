// Orders of insertion are permutations along a curve or at random.
#include "delaunay/insertion/insertion_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "delaunay/methods.h"
#include "tests/delaunay/hard_points.h"
#include "tests/delaunay/hard_points_3d.h"

namespace delray::delaunay {
namespace {

TEST(InsertionOrder, IsAPermutation) {
  for (const Choice& order : orders()) {
    for (const HardPoints& kind : hard_points()) {
      for (const std::size_t n : {0, 1, 2, 63, 64, 65, 1000}) {
        std::vector<std::uint32_t> numbers = insertion_order(kind.make(n, 1), order.name, 5);
        std::sort(numbers.begin(), numbers.end());
        std::vector<std::uint32_t> expected(n);
        std::iota(expected.begin(), expected.end(), 0U);
        EXPECT_EQ(numbers, expected) << order.name << ", " << kind.name << ", " << n;
      }
    }
  }
}

TEST(InsertionOrder, IsAPermutationInSpaceToo) {
  for (const Choice& order : orders()) {
    for (const HardPoints3d& kind : hard_points_3d()) {
      for (const std::size_t n : {1, 65, 500}) {
        const auto points = kind.make(n, 1);
        std::vector<std::uint32_t> numbers = insertion_order(points, order.name, 5, 0.6);
        std::sort(numbers.begin(), numbers.end());
        std::vector<std::uint32_t> expected(n);
        std::iota(expected.begin(), expected.end(), 0U);
        EXPECT_EQ(numbers, expected) << order.name << ", " << kind.name << ", " << n;
      }
    }
  }
}

TEST(InsertionOrder, HilbertVisitsNeighbouringCellsOfSpaceInTurn) {
  std::vector<glm::dvec3> lattice;
  for (int i = 0; i < 512; ++i) lattice.emplace_back(i / 64, i / 8 % 8, i % 8);
  const auto numbers = insertion_order(lattice, "hilbert", 1);
  for (std::size_t i = 1; i < numbers.size(); ++i) {
    const glm::dvec3 step = abs(lattice[numbers[i]] - lattice[numbers[i - 1]]);
    EXPECT_EQ(step.x + step.y + step.z, 1) << i;
  }
}

TEST(InsertionOrder, StartTurnsTheCurveRound) {
  const Points points = hard_points().front().make(100, 1);
  auto numbers = insertion_order(points, "hilbert", 1);
  std::rotate(numbers.begin(), numbers.begin() + 25, numbers.end());
  EXPECT_EQ(insertion_order(points, "hilbert", 1, 0.25), numbers);
}

TEST(InsertionOrder, HilbertVisitsNeighbouringCellsInTurn) {
  Points lattice;
  for (int x = 0; x < 32; ++x) {
    for (int y = 0; y < 32; ++y) lattice.emplace_back(x, y);
  }
  const auto numbers = insertion_order(lattice, "hilbert", 1);
  for (std::size_t i = 1; i < numbers.size(); ++i) {
    const glm::dvec2 step = lattice[numbers[i]] - lattice[numbers[i - 1]];
    EXPECT_EQ(std::abs(step.x) + std::abs(step.y), 1) << i;
  }
}

TEST(InsertionOrder, RandomDependsOnTheSeedAlone) {
  const Points points = hard_points().front().make(500, 1);
  for (const std::string name : {"random", "brio"}) {
    EXPECT_EQ(insertion_order(points, name, 3), insertion_order(points, name, 3));
    EXPECT_NE(insertion_order(points, name, 3), insertion_order(points, name, 4));
  }
}

// The last round of brio holds half of the points, and it is a random half.
TEST(InsertionOrder, BrioTakesARandomHalfLast) {
  const Points points = hard_points().front().make(4000, 1);
  const auto numbers = insertion_order(points, "brio", 1);
  const auto upper = std::count_if(numbers.begin() + 2000, numbers.end(),
                                   [](std::uint32_t number) { return number >= 2000; });
  EXPECT_NEAR(static_cast<double>(upper), 1000, 100);  // six standard deviations
}

}  // namespace
}  // namespace delray::delaunay
