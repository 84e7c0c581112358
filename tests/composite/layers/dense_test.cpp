#include "composite/dense.h"

#include <gtest/gtest.h>

namespace delray::composite {
namespace {

using image::Image8;
using image::Rgba8;

// Ten pixels, all drawn by `who` at depth 1 but pixel 3, which is empty.
Image8 picture(std::uint8_t who) {
  Image8 image(10, 1);
  clear(image);
  for (std::size_t i = 0; i < 10; ++i) {
    if (i == 3) continue;
    image.colour[i] = {who, 0, 0, 255};
    image.depth[i] = 1;
  }
  return image;
}

TEST(DenseLayer, MergesOnlyTheRangeAndTheLowerSideWinsTies) {
  for (const Side side : {Side::lower, Side::higher}) {
    DenseLayer<Rgba8> layer(picture(1)), other(picture(2));
    EXPECT_EQ(layer.merge({2, 6}, other.encode({2, 6}), side), 4U);
    for (std::size_t i = 0; i < 10; ++i) {
      const bool taken = side == Side::lower && i >= 2 && i < 6;
      EXPECT_EQ(layer.image().colour[i].r, i == 3 ? 0 : taken ? 2 : 1) << i;
    }
  }
}

TEST(DenseLayer, ReplaceTakesWhateverWasCut) {
  DenseLayer<Rgba8> layer(picture(1)), other(picture(2));
  other.image().depth[5] = 9;
  layer.replace({3, 7}, other.encode({3, 7}));
  EXPECT_EQ(layer.image().colour[2].r, 1);
  EXPECT_EQ(layer.image().colour[3].r, 0);
  EXPECT_EQ(layer.image().colour[4].r, 2);
  EXPECT_EQ(layer.image().depth[5], 9);
  EXPECT_EQ(layer.image().colour[7].r, 1);
}

TEST(DenseLayer, CutsEmptyRanges) {
  DenseLayer<Rgba8> layer(picture(1));
  EXPECT_TRUE(layer.encode({4, 4}).empty());
  EXPECT_EQ(layer.merge({10, 10}, layer.encode({10, 10}), Side::lower), 0U);
}

TEST(DenseLayer, IsEmptyWhenNothingIsCovered) {
  Image8 image(4, 4);
  clear(image, Rgba8{1, 2, 3, 4});
  DenseLayer<Rgba8> layer(std::move(image));
  EXPECT_TRUE(layer.empty());
  layer.image().depth[15] = 1e30F;
  EXPECT_FALSE(layer.empty());
}

TEST(DenseLayer, LargeRangesAreSplitOverThreads) {
  const int width = 1000, height = 300;
  Image8 nearer(width, height), farther(width, height);
  clear(nearer);
  clear(farther, Rgba8{9, 9, 9, 255});
  for (std::size_t i = 0; i < nearer.pixels(); ++i) {
    nearer.colour[i] = {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i >> 8), 0, 255};
    nearer.depth[i] = 1;
    farther.depth[i] = i % 2 == 0 ? 0.5F : 2.0F;
  }
  DenseLayer<Rgba8> layer(std::move(farther)), other(std::move(nearer));
  const PixelRange range{1, 299999};
  EXPECT_EQ(layer.merge(range, other.encode(range), Side::higher), range.size());
  for (std::size_t i = 0; i < other.image().pixels(); ++i) {
    const bool taken = i % 2 == 1 && i < range.end;
    ASSERT_EQ(layer.image().colour[i], taken ? other.image().colour[i] : (Rgba8{9, 9, 9, 255}))
        << i;
  }
}

}  // namespace
}  // namespace delray::composite
