// Fewer points, none of which was far from one that stays.
#include "packs/build/thin_points.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace delray::packs::internal {
namespace {

scenes::Mesh points_on_a_surface(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(-1, 1);
  scenes::Mesh mesh;
  mesh.shape.kind = scenes::Shape::Kind::point;
  for (int i = 0; i < n; ++i) {
    const float x = place(random), y = place(random);
    mesh.positions.emplace_back(x, y, 0.2F * std::sin(3 * x));
    mesh.colours.emplace_back(x, y, static_cast<float>(i), 1);
    mesh.triangles.emplace_back(static_cast<std::uint32_t>(i));
  }
  return mesh;
}

// The largest distance, with what it was before, of a point to one that stays.
float largest_distance(const scenes::Mesh& all, std::span<const float> before,
                       const scenes::Mesh& kept) {
  float largest = 0;
  for (std::size_t i = 0; i < all.positions.size(); ++i) {
    float nearest = 1e30F;
    for (const glm::vec3& p : kept.positions)
      nearest = std::min(nearest, glm::distance(p, all.positions[i]));
    largest = std::max(largest, nearest + (before.empty() || nearest == 0 ? 0 : before[i]));
  }
  return largest;
}

TEST(ThinPoints, LeavesOutWhatIsNearToOthers) {
  for (const unsigned seed : {1U, 2U}) {
    const scenes::Mesh mesh = points_on_a_surface(1500, seed);
    const ThinnedPoints half = thin_points({mesh}, 750);
    EXPECT_LE(half.mesh.positions.size(), 750U);
    EXPECT_GE(half.mesh.positions.size(), 600U);
    EXPECT_LE(largest_distance(mesh, {}, half.mesh), half.errors.largest);
    EXPECT_LE(half.errors.largest, 0.08F);  // spacing of a lattice: 0.05
    ASSERT_EQ(half.errors.triangles.size(), half.mesh.triangles.size());
    for (std::size_t i = 0; i < half.mesh.positions.size(); ++i) {  // they keep their colours
      const auto number = static_cast<std::size_t>(half.mesh.colours[i].z);
      EXPECT_EQ(half.mesh.positions[i], mesh.positions[number]);
    }
    const ThinnedPoints quarter = thin_points({half.mesh, half.errors.triangles}, 375);
    EXPECT_LE(largest_distance(mesh, {}, quarter.mesh), quarter.errors.largest);
    EXPECT_GE(quarter.errors.largest, half.errors.largest);
    // Measured against all points, errors do not add up.
    const ThinnedPoints of_all = thin_points({mesh}, 375);
    EXPECT_LE(largest_distance(mesh, {}, of_all.mesh), of_all.errors.largest);
    EXPECT_LT(of_all.errors.largest, 0.9F * quarter.errors.largest);
    EXPECT_LE(of_all.mesh.positions.size(), 375U);
  }
}

TEST(ThinPoints, KnowsWhomEachStandsFor) {
  const scenes::Mesh mesh = points_on_a_surface(1000, 5);
  const ThinnedPoints quarter = thin_points({mesh}, 250);
  std::vector<float> largest(quarter.mesh.positions.size(), 0);
  ASSERT_EQ(quarter.errors.nearest.size(), mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const std::uint32_t point = quarter.errors.nearest[i];
    ASSERT_LT(point, largest.size());
    const float distance = glm::distance(mesh.positions[i], quarter.mesh.positions[point]);
    largest[point] = std::max(largest[point], distance);
  }
  for (std::size_t i = 0; i < largest.size(); ++i) {
    EXPECT_LE(largest[i], quarter.errors.triangles[i]);
    EXPECT_GE(largest[i], 0.999F * quarter.errors.triangles[i]);
  }
}

// The thinnest cover of a plane takes 0.385 points for a square of the radius, dart throwing 0.66
// or more; there are some more for the border.
TEST(ThinPoints, CoversWithFew) {
  const scenes::Mesh mesh = points_on_a_surface(20000, 11);
  const ThinnedPoints few = thin_points({mesh}, 300);
  const float area = 4;
  EXPECT_LE(largest_distance(mesh, {}, few.mesh), few.errors.largest);
  EXPECT_LT(static_cast<float>(few.mesh.positions.size()) * few.errors.largest *
                few.errors.largest / area,
            0.6F);
}

// A scan with a stray return: rounding there is not small beside the distances of the others.
TEST(ThinPoints, BesideOneFarAwayAreNearToOneThatStays) {
  for (const float far : {1e3F, 1.5e5F, 2e5F, 7e6F, 1e8F, 1e18F, 1e30F}) {
    scenes::Mesh mesh = points_on_a_surface(3000, 17);
    mesh.positions[1234] = glm::vec3(-far);
    const ThinnedPoints half = thin_points({mesh}, 1500);
    EXPECT_LE(half.mesh.positions.size(), 1500U) << far;
    EXPECT_LE(largest_distance(mesh, {}, half.mesh), half.errors.largest * (1 + 1e-5F)) << far;
  }
}

TEST(ThinPoints, DoNotDependMuchOnWhatIsExpected) {
  const scenes::Mesh mesh = points_on_a_surface(3000, 29);
  const float error = thin_points({mesh}, 1000).errors.largest;
  for (const float expected : {1e-30F, 0.001F, 0.5F * error, error, 2 * error, 10.0F, 1e30F}) {
    const ThinnedPoints third = thin_points({mesh}, 1000, expected);
    EXPECT_LE(third.mesh.positions.size(), 1000U) << expected;
    EXPECT_GE(third.mesh.positions.size(), 800U) << expected;
    EXPECT_LE(largest_distance(mesh, {}, third.mesh), third.errors.largest) << expected;
    EXPECT_LE(third.errors.largest, 1.1F * error) << expected;
  }
}

TEST(ThinPoints, StayOnceWhateverTheirErrorWasBefore) {
  const scenes::Mesh mesh = points_on_a_surface(4000, 23);
  std::vector<float> before(4000, 0);
  for (std::size_t i = 0; i < before.size(); i += 9) before[i] = 0.2F;
  const ThinnedPoints half = thin_points({mesh, before}, 2000);
  std::set<float> numbers;
  for (const glm::vec4& colour : half.mesh.colours) numbers.insert(colour.z);
  EXPECT_EQ(numbers.size(), half.mesh.colours.size());
  EXPECT_LE(largest_distance(mesh, before, half.mesh), half.errors.largest);
}

TEST(ThinPoints, OfOnePlaceLeavesOne) {
  scenes::Mesh mesh = points_on_a_surface(50, 3);
  for (glm::vec3& p : mesh.positions) p = {1, 2, 3};
  const ThinnedPoints one = thin_points({mesh}, 25);
  EXPECT_EQ(one.mesh.positions.size(), 1U);
  EXPECT_EQ(one.errors.largest, 0);
}

}  // namespace
}  // namespace delray::packs::internal
