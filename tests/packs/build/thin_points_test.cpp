// Fewer points, none of which was far from one that stays.
#include "packs/build/thin_points.h"

#include <gtest/gtest.h>

#include <random>

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
    const Simplified half = thin_points(mesh);
    EXPECT_LE(half.mesh.positions.size(), 751U);
    EXPECT_GE(half.mesh.positions.size(), 500U);
    EXPECT_LE(largest_distance(mesh, {}, half.mesh), half.largest_error);
    EXPECT_LE(half.largest_error, 0.08F);  // spacing of a lattice: 0.05
    ASSERT_EQ(half.errors.size(), half.mesh.triangles.size());
    for (std::size_t i = 0; i < half.mesh.positions.size(); ++i) {  // they keep their colours
      const auto number = static_cast<std::size_t>(half.mesh.colours[i].z);
      EXPECT_EQ(half.mesh.positions[i], mesh.positions[number]);
    }
    const Simplified quarter = thin_points(half.mesh, half.errors);
    EXPECT_LE(largest_distance(mesh, {}, quarter.mesh), quarter.largest_error);
    EXPECT_GE(quarter.largest_error, half.largest_error);
  }
}

TEST(ThinPoints, OfOnePlaceLeavesOne) {
  scenes::Mesh mesh = points_on_a_surface(50, 3);
  for (glm::vec3& p : mesh.positions) p = {1, 2, 3};
  const Simplified one = thin_points(mesh);
  EXPECT_EQ(one.mesh.positions.size(), 1U);
  EXPECT_EQ(one.largest_error, 0);
}

}  // namespace
}  // namespace delray::packs::internal
