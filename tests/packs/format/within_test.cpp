#include "packs/format/within.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

#include "tests/support/targets.h"

namespace delray::packs::internal {
namespace {

// One coordinate of any place outside by one step, or not a number, is found; the border is inside.
TEST(Within, FindsWhatIsNotOnEveryTarget) {
  const geometry::Box3 box{glm::vec3(-1, 0, 2), glm::vec3(1, 0.5F, 7)};
  std::mt19937 random(1);
  tests::for_each_target([&] {
    for (const std::size_t count : {0U, 1U, 5U, 15U, 16U, 17U, 100U}) {
      std::vector<glm::vec3> places(count);
      for (glm::vec3& p : places) {
        for (int k = 0; k < 3; ++k)
          p[k] = std::uniform_real_distribution<float>(box.low[k], box.high[k])(random);
      }
      if (count > 0) places.front() = box.low, places.back() = box.high;
      EXPECT_TRUE(are_within(box, places)) << count;
      for (std::size_t i = 0; i < count; ++i) {
        for (int k = 0; k < 3; ++k) {
          const float before = places[i][k];
          for (const float wrong :
               {std::nextafter(box.low[k], -9.0F), std::nextafter(box.high[k], 9.0F),
                std::numeric_limits<float>::quiet_NaN()}) {
            places[i][k] = wrong;
            EXPECT_FALSE(are_within(box, places)) << i << " of " << count;
          }
          places[i][k] = before;
        }
      }
    }
  });
}

}  // namespace
}  // namespace delray::packs::internal
