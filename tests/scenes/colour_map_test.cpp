#include "scenes/colour_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace delray::scenes {
namespace {

TEST(ColourMap, StaysInRangeAndIsContinuousFromEndToEnd) {
  for (const ColourMap& map : colour_maps()) {
    glm::vec3 before = map.colour(0);
    for (int i = 0; i <= 2000; ++i) {
      const glm::vec3 c = map.colour(static_cast<float>(i) / 2000);
      EXPECT_TRUE(glm::all(glm::greaterThanEqual(c, glm::vec3(0)))) << map.name;
      EXPECT_TRUE(glm::all(glm::lessThanEqual(c, glm::vec3(1)))) << map.name;
      EXPECT_LT(glm::distance(c, before), 0.03F) << map.name << " at " << i;
      before = c;
    }
    EXPECT_EQ(map.colour(-3), map.colour(0)) << map.name;
    EXPECT_EQ(map.colour(7), map.colour(1)) << map.name;
    EXPECT_EQ(map.colour(std::nanf("")), map.colour(0)) << map.name;
    EXPECT_NE(map.colour(0), map.colour(1)) << map.name;
  }
}

TEST(ColourMap, ViridisAndGreyGrowBrighter) {
  for (const char* name : {"viridis", "grey", "heat"}) {
    float before = -1;
    for (int i = 0; i <= 100; ++i) {
      const glm::vec3 c = colour_map(name).colour(static_cast<float>(i) / 100);
      const float luminance = 0.2126F * c.x + 0.7152F * c.y + 0.0722F * c.z;
      EXPECT_GT(luminance, before) << name << " at " << i;
      before = luminance;
    }
  }
}

TEST(ColourMap, AnUnknownNameListsThoseThatThereAre) {
  try {
    colour_map("jet");
    FAIL();
  } catch (const std::invalid_argument& e) {
    for (const ColourMap& map : colour_maps()) {
      EXPECT_NE(std::string(e.what()).find(map.name), std::string::npos);
    }
  }
}

TEST(ColourMap, ClassesThatMeanSomethingDiffer) {
  for (unsigned a = 0; a < 19; ++a) {
    for (unsigned b = 0; b < a; ++b) EXPECT_NE(classification_colour(a), classification_colour(b));
  }
  EXPECT_NE(classification_colour(64), classification_colour(65));
  EXPECT_EQ(classification_colour(255), classification_colour(255));
}

}  // namespace
}  // namespace delray::scenes
