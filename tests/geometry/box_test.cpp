// Boxes: empty, huge, and of one point.
#include "geometry/box.h"

#include <gtest/gtest.h>

namespace delray::geometry {
namespace {

TEST(Box, DefaultIsEmptyAndIdentity) {
  Box3 box;
  EXPECT_TRUE(box.empty());
  EXPECT_EQ(box.size(), glm::vec3(0));
  const Box3 other{{1, 2, 3}, {4, 5, 6}};
  box.include(other);
  EXPECT_EQ(box, other);
  box.include(Box3{});
  EXPECT_EQ(box, other);
}

TEST(Box, CentreOfHugeBoxDoesNotOverflow) {
  const float huge = std::numeric_limits<float>::max();
  const Box2 box{{-huge, huge / 2}, {huge, huge}};
  EXPECT_EQ(box.centre(), glm::vec2(0, huge * 0.75F));
}

TEST(Box, OnePointIsNotEmpty) {
  Box2 box;
  box.include(glm::vec2(3, -4));
  EXPECT_FALSE(box.empty());
  EXPECT_EQ(box.centre(), glm::vec2(3, -4));
}

}  // namespace
}  // namespace delray::geometry
