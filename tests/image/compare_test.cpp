#include "image/compare.h"

#include <gtest/gtest.h>

#include <cmath>

#include "image/hash.h"

namespace delray::image {
namespace {

template <class Colour>
BasicImage<Colour> blank(int w, int h) {
  BasicImage<Colour> image(w, h);
  clear(image);
  return image;
}

TEST(Compare, EqualPictures) {
  EXPECT_TRUE(compare(blank<Rgba8>(5, 3), blank<Rgba8>(5, 3)).equal());
  EXPECT_TRUE(compare(blank<RgbaF>(5, 3), blank<RgbaF>(5, 3)).equal());
  EXPECT_TRUE(compare(Image8(), Image8()).equal());
}

TEST(Compare, CountsEachKindOfDifferenceOnce) {
  const auto a = blank<Rgba8>(300, 300);
  auto b = blank<Rgba8>(300, 300);
  b.colour[0].r = 3;
  b.colour[0].a = 7;
  b.colour[70000].b = 2;
  b.depth[5] = 1;
  const Comparison result = compare(a, b);
  EXPECT_EQ(result.colour_differs, 2U);
  EXPECT_EQ(result.depth_differs, 1U);
  EXPECT_EQ(result.coverage_differs, 1U);
  EXPECT_EQ(result.max_channel_difference, 7);
  EXPECT_FALSE(result.equal());
}

TEST(Compare, FloatPicturesBitByBit) {
  const float nan = std::nanf("");
  auto a = blank<RgbaF>(4, 1), b = blank<RgbaF>(4, 1);
  a.colour[0].r = 0.0F;
  b.colour[0].r = -0.0F;
  a.colour[1].g = b.colour[1].g = nan;
  b.colour[2].b = 0.25F;
  a.depth[3] = 1.0F;
  b.depth[3] = std::nextafter(1.0F, 2.0F);
  Comparison result = compare(a, b);
  EXPECT_EQ(result.colour_differs, 2U);
  EXPECT_EQ(result.depth_differs, 1U);
  EXPECT_EQ(result.coverage_differs, 0U);
  EXPECT_EQ(result.max_channel_difference, 0.25);
  b.colour[2].b = nan;
  EXPECT_TRUE(std::isinf(compare(a, b).max_channel_difference));
}

TEST(DifferencePicture, AmplifiesAndMarksAlpha) {
  auto a = blank<Rgba8>(4, 1), b = blank<Rgba8>(4, 1);
  a.colour[1] = {10, 0, 200, 0};
  b.colour[1] = {7, 1, 0, 0};
  b.colour[2].a = 5;
  const Image8 picture = difference_picture(a, b, 8);
  EXPECT_EQ(picture.colour[0], (Rgba8{0, 0, 0, 255}));
  EXPECT_EQ(picture.colour[1], (Rgba8{24, 8, 255, 255}));
  EXPECT_EQ(picture.colour[2], (Rgba8{0, 0, 40, 255}));
}

}  // namespace
}  // namespace delray::image
