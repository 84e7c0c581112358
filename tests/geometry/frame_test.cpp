// Frames are orthonormal and right-handed.
#include "geometry/frame.h"

#include <gtest/gtest.h>

#include <random>

namespace delray::geometry {
namespace {

TEST(Frame, IsOrthonormalAndRightHanded) {
  const unsigned seed = 7;
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  std::vector<glm::vec3> directions = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}};
  for (int i = 0; i < 1000; ++i) {
    directions.push_back(glm::normalize(glm::vec3(normal(random), normal(random), normal(random))));
  }
  for (const glm::vec3& n : directions) {
    const Frame frame = frame_around(n);
    SCOPED_TRACE(testing::Message() << "seed " << seed << " n " << n.x << ' ' << n.y << ' ' << n.z);
    EXPECT_NEAR(glm::dot(frame.tangent, frame.bitangent), 0, 1e-5);
    EXPECT_NEAR(glm::dot(frame.tangent, n), 0, 1e-5);
    EXPECT_NEAR(glm::length(frame.tangent), 1, 1e-5);
    EXPECT_NEAR(glm::length(glm::cross(frame.tangent, frame.bitangent) - n), 0, 1e-5);
    const glm::vec3 v{0.3F, -2, 5};
    EXPECT_NEAR(glm::length(frame.to_local(frame.to_world(v)) - v), 0, 1e-4);
  }
}

}  // namespace
}  // namespace delray::geometry
