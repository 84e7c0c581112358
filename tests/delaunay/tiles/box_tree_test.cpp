#include "delaunay/tiles/box_tree.h"

#include <gtest/gtest.h>

#include <glm/glm.hpp>
#include <random>
#include <vector>

namespace delray::delaunay {
namespace {

TEST(BoxTree, FindsWhatAPlainLoopFinds) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<> unit(0, 1);
  using Box = geometry::Box<glm::dvec2>;
  for (const int n : {0, 1, 2, 3, 50, 333}) {
    std::vector<Box> boxes;
    for (int i = 0; i < n; ++i) {
      const glm::dvec2 low(unit(random), unit(random));
      boxes.push_back(i % 7 == 3 ? Box{} : Box{low, low + 0.1 * glm::dvec2(unit(random), 0)});
    }
    const BoxTree<glm::dvec2> tree(boxes);
    for (int i = 0; i < 50; ++i) {
      const glm::dvec2 p(unit(random), unit(random));
      const auto touches = [&](const Box& box) {
        return glm::length(glm::clamp(p, box.low, box.high) - p) < 0.2;
      };
      std::vector<std::uint32_t> found, expected;
      tree.find(touches, [&](std::uint32_t k) { found.push_back(k); });
      for (std::uint32_t k = 0; k < boxes.size(); ++k) {
        if (!boxes[k].empty() && touches(boxes[k])) expected.push_back(k);
      }
      std::ranges::sort(found);
      ASSERT_EQ(found, expected) << n << " boxes, query " << i;
    }
  }
}

}  // namespace
}  // namespace delray::delaunay
