#include "packs/page_tree.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace delray::packs {
namespace {

TEST(PageTree, ReachesEveryPageOnceAndInOrder) {
  for (const std::uint32_t n : {0U, 1U, 7U, 8U, 9U, 64U, 65U, 1000U}) {
    std::vector<PageRow> rows(n + 5);
    std::mt19937 random(n);
    for (PageRow& row : rows)
      row.box.include(
          glm::vec3(static_cast<float>(random() % 100), static_cast<float>(random() % 100), 0));
    const PageTree tree(rows, {5, n}, {});
    std::vector<std::uint32_t> found;
    tree.descend([](const PageTree::Node&) { return true; },
                 [&](std::uint32_t page) { found.push_back(page); });
    std::vector<std::uint32_t> expected(n);
    std::iota(expected.begin(), expected.end(), 5U);
    EXPECT_EQ(found, expected);

    // Those to the left of a line, by the boxes of nodes.
    std::size_t left = 0, reached = 0;
    for (const std::uint32_t page : expected) left += rows[page].box.low.x < 10 ? 1 : 0;
    tree.descend([](const PageTree::Node& node) { return node.box.low.x < 10; },
                 [&](std::uint32_t page) { reached += rows[page].box.low.x < 10 ? 1 : 0; });
    EXPECT_EQ(reached, left);
  }
}

}  // namespace
}  // namespace delray::packs
