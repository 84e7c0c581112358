#include "scenes/geometry/origin.h"

#include <gtest/gtest.h>

namespace delray::scenes::internal {
namespace {

TEST(Origin, IsZeroUpToKFarDiagonalsAndTheCentreBeyond) {
  EXPECT_EQ(origin_of({}), glm::dvec3(0));
  EXPECT_EQ(origin_of({{63, 0, 0}, {64, 0, 0}}), glm::dvec3(0));
  EXPECT_EQ(origin_of({{64, 0, 0}, {65, 0, 0}}), glm::dvec3(64.5, 0, 0));
  EXPECT_EQ(origin_of({{0, -65, 0}, {0, -64, 0}}), glm::dvec3(0, -64.5, 0));
  EXPECT_EQ(origin_of({{0, 0, 0}, {1e-30, 0, 0}}), glm::dvec3(0));
  EXPECT_EQ(origin_of({{0, 0, 0}, {0, 0, 0}}), glm::dvec3(0));
}

TEST(Origin, SmallDifferencesOfLargeNumbersStay) {
  const std::vector<glm::dvec3> places = {{1e9, 0, 0}, {1e9 + 0.25, 0, 0.5}};
  const glm::dvec3 origin = origin_of(box_of(places));
  EXPECT_EQ(origin, glm::dvec3(1e9 + 0.125, 0, 0.25));
  EXPECT_EQ(relative_to(origin, places),
            (std::vector<glm::vec3>{{-0.125F, 0, -0.25F}, {0.125F, 0, 0.25F}}));
  std::vector<glm::vec3> positions = {{64, 0, 0}, {65, 0, 0}};
  make_relative_to(origin_of(box_of(positions)), positions);
  EXPECT_EQ(positions, (std::vector<glm::vec3>{{-0.5F, 0, 0}, {0.5F, 0, 0}}));
}

}  // namespace
}  // namespace delray::scenes::internal
