// Rectangles: half-open, empty, and large areas.
#include "geometry/rect.h"

#include <gtest/gtest.h>

namespace delray::geometry {
namespace {

TEST(Rect, AreaDoesNotOverflowAnInt) {
  EXPECT_EQ((Rect{0, 0, 1 << 20, 1 << 20}.area()), std::int64_t{1} << 40);
}

TEST(Rect, InvertedIsEmpty) {
  const Rect inverted{5, 5, 3, 9};
  EXPECT_TRUE(inverted.empty());
  EXPECT_EQ(inverted.area(), 0);
  EXPECT_FALSE(inverted.contains(4, 6));
}

TEST(Rect, IntersectionOfDisjointIsEmpty) {
  EXPECT_TRUE(intersection({0, 0, 2, 2}, {2, 0, 4, 2}).empty());
  EXPECT_EQ(intersection({0, 0, 5, 5}, {3, -2, 9, 4}), (Rect{3, 0, 5, 4}));
}

TEST(Rect, IsHalfOpen) {
  const Rect rect{1, 1, 3, 2};
  EXPECT_TRUE(rect.contains(2, 1));
  EXPECT_FALSE(rect.contains(3, 1));
  EXPECT_FALSE(rect.contains(1, 2));
}

}  // namespace
}  // namespace delray::geometry
