#include <gtest/gtest.h>

#include <cmath>

#include "raster/distribute/coverage.h"
#include "raster/pipeline/screen.h"

namespace delray::raster {
namespace {

using geometry::Rect;

constexpr double kPixels = 64 * 64;

Screen screen() {
  Screen result;
  result.width = result.height = 64;
  return result;
}

double seen_of(double layers) { return (1 - std::exp(-layers)) / layers; }

TEST(SurfaceCoverage, NothingHidesWhatIsAlone) {
  const Screen s = screen();
  const Coverage coverage(s, 1);
  EXPECT_EQ(coverage.seen({0, 0, 64, 64}, coverage.layers(false)), 1);
  EXPECT_EQ(coverage.seen({0, 0, 64, 64}, coverage.layers(true)), 1);
}

TEST(SurfaceCoverage, OpaqueSurfacesHideBothKinds) {
  const Screen s = screen();
  Coverage coverage(s, 1);
  coverage.add(s.frame(), 3 * kPixels, {false, 1});
  EXPECT_NEAR(coverage.seen({0, 0, 64, 64}, coverage.layers(false)), seen_of(3), 1e-12);
  EXPECT_NEAR(coverage.seen({0, 0, 64, 64}, coverage.layers(true)), seen_of(3), 1e-12);
}

TEST(SurfaceCoverage, BlendedSurfacesHideBlendedOnesAsFarAsTheyAreOpaque) {
  const Screen s = screen();
  Coverage coverage(s, 1);
  coverage.add(s.frame(), 1 * kPixels, {false, 1});
  coverage.add(s.frame(), 4 * kPixels, {true, 0.75});
  coverage.add(s.frame(), 9 * kPixels, {true, 0});
  EXPECT_NEAR(coverage.seen({0, 0, 64, 64}, coverage.layers(false)), seen_of(1), 1e-12);
  EXPECT_NEAR(coverage.seen({0, 0, 64, 64}, coverage.layers(true)), seen_of(1 + 4 * 0.75), 1e-12);
}

TEST(SurfaceCoverage, OnlyWhereTheyAre) {
  const Screen s = screen();
  Coverage coverage(s, 1);
  coverage.add({0, 0, 32, 64}, 2 * kPixels / 2, {false, 1});
  EXPECT_NEAR(coverage.seen({0, 0, 16, 16}, coverage.layers(true)), seen_of(2), 1e-12);
  EXPECT_EQ(coverage.seen({32, 0, 64, 64}, coverage.layers(true)), 1);
}

// Two triangles that together cover the screen, as often as told.
void add_screenfuls(Coverage& coverage, int times, const Coverage::Surface& surface) {
  const int side = 64 * kSubpixels;
  ScreenTriangle lower, upper;
  lower.vertex[0] = {0, 0}, lower.vertex[1] = {side, 0}, lower.vertex[2] = {0, side};
  upper.vertex[0] = {side, 0}, upper.vertex[1] = {side, side}, upper.vertex[2] = {0, side};
  for (int i = 0; i < times; ++i) {
    coverage.add_large(lower, surface);
    coverage.add_large(upper, surface);
  }
}

TEST(SurfaceCoverage, LargeTrianglesCostWhatIsSeenAndDrawnOfThem) {
  const Screen s = screen();
  Coverage coverage(s, 1);
  add_screenfuls(coverage, 2, {false, 1});
  add_screenfuls(coverage, 4, {true, 0.5});
  // Points of the diagonal may count for both triangles.
  EXPECT_NEAR(coverage.seen(s.frame(), coverage.layers(false)), seen_of(2), 0.02);
  EXPECT_NEAR(coverage.seen(s.frame(), coverage.layers(true)), seen_of(4), 0.02);
  double seen = 0, drawn = 0;
  for (const loadbalance::WeightedBox& box : coverage.costs_of_large(1, 0)) seen += box.cost;
  for (const loadbalance::WeightedBox& box : coverage.costs_of_large(0, 1)) drawn += box.cost;
  EXPECT_NEAR(drawn, 6 * kPixels, 0.08 * 6 * kPixels);
  const double expected = (2 * seen_of(2) + 4 * seen_of(4)) * kPixels;
  EXPECT_NEAR(seen, expected, 0.08 * expected);
}

}  // namespace
}  // namespace delray::raster
