#include "raster/shading/eye_dome.h"

#include <gtest/gtest.h>

#include "tests/raster/coverage.h"

namespace delray::raster {
namespace {

// White, at a distance that the column says.
template <class Distance>
image::ImageF columns(int width, int height, Distance&& distance) {
  image::ImageF image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.colour[y * width + x] = {1, 1, 1, 1};
      image.depth[y * width + x] = distance(x);
    }
  }
  return image;
}

TEST(EyeDome, LeavesWhatFacesTheViewerAndDarkensWhatIsBehindAStep) {
  constexpr int kWidth = 40, kHeight = 20;
  image::ImageF flat = columns(kWidth, kHeight, [](int) { return 3.0F; });
  light_by_eye_dome(plain_view(kWidth, kHeight), flat);
  for (std::size_t i = 0; i < flat.pixels(); ++i) EXPECT_EQ(flat.colour[i].g, 1);

  image::ImageF step = columns(kWidth, kHeight, [](int x) { return x < 20 ? 2.0F : 5.0F; });
  light_by_eye_dome(plain_view(kWidth, kHeight), step);
  for (int x = 0; x < kWidth; ++x) {
    const image::RgbaF& colour = step.colour[10 * kWidth + x];
    if (x == 20 || x == 21) {
      EXPECT_LT(colour.g, 0.95F) << x;
    } else {
      EXPECT_EQ(colour.g, 1) << x;
    }
    EXPECT_EQ(colour.a, 1);
    EXPECT_EQ(step.depth[10 * kWidth + x], x < 20 ? 2.0F : 5.0F);
  }
}

TEST(EyeDome, LeavesEmptyPixelsAndWhatIsBesideThem) {
  constexpr int kWidth = 30, kHeight = 9;
  image::ImageF image =
      columns(kWidth, kHeight, [](int x) { return x == 15 ? 2.0F : image::kEmptyDepth; });
  for (int i = 0; i < kWidth * kHeight; ++i) {
    if (i % kWidth != 15) image.colour[i] = {};
  }
  light_by_eye_dome(plain_view(kWidth, kHeight), image);
  for (int x = 0; x < kWidth; ++x) EXPECT_EQ(image.colour[4 * kWidth + x].a, x == 15 ? 1 : 0);
  EXPECT_EQ(image.colour[4 * kWidth + 15].r, 1);
}

TEST(EyeDome, DependsOnNoUnitOfLength) {
  constexpr int kWidth = 32, kHeight = 16;
  const auto slope = [](float unit) {
    return columns(kWidth, kHeight, [=](int x) { return (4.0F + 0.25F * float(x % 7)) * unit; });
  };
  image::ImageF one = slope(1), large = slope(1024);
  light_by_eye_dome(plain_view(kWidth, kHeight), one);
  light_by_eye_dome(plain_view(kWidth, kHeight), large);
  for (std::size_t i = 0; i < one.pixels(); ++i) EXPECT_EQ(one.colour[i].r, large.colour[i].r);
}

}  // namespace
}  // namespace delray::raster
