// The beach line beside a plain list.
#include "delaunay/construction/beach_line.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace delray::delaunay::internal {
namespace {

TEST(BeachLine, IsTheListThatInsertionsAndRemovalsMake) {
  std::mt19937_64 random(7);
  BeachLine line;
  std::vector<ArcNumber> list = {line.insert_after(kNoArc, 0)};
  for (VertexNumber site = 1; site < 3000; ++site) {
    const std::size_t at = random() % list.size();
    if (random() % 3 == 0 && list.size() > 1) {
      line.remove(list[at]);
      list.erase(list.begin() + static_cast<std::ptrdiff_t>(at));
    } else {
      const ArcNumber made = line.insert_after(list[at], site);
      list.insert(list.begin() + static_cast<std::ptrdiff_t>(at) + 1, made);
    }
    const std::size_t wanted = random() % list.size();
    std::vector<std::size_t> place(3001);
    for (std::size_t i = 0; i < list.size(); ++i) place[list[i]] = i;
    const ArcNumber found =
        line.find([&](ArcNumber arc, ArcNumber) { return place[arc] < wanted; });
    ASSERT_EQ(found, list[wanted]) << site;
  }
  ASSERT_GT(list.size(), 500U);
  for (std::size_t i = 0; i < list.size(); ++i) {
    EXPECT_EQ(line.next(list[i]), i + 1 < list.size() ? list[i + 1] : kNoArc);
    EXPECT_EQ(line.previous(list[i]), i > 0 ? list[i - 1] : kNoArc);
  }
}

TEST(BeachLine, AnArcThatComesBackHasAnotherLife) {
  BeachLine line;
  const ArcNumber first = line.insert_after(kNoArc, 0), second = line.insert_after(first, 1);
  const std::uint64_t life = line.life(second);
  line.remove(second);
  EXPECT_NE(line.life(second), life);
  EXPECT_EQ(line.insert_after(first, 2), second);
  EXPECT_NE(line.life(second), life);
}

}  // namespace
}  // namespace delray::delaunay::internal
