#include "composite/deep_shape.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "composite/deep.h"

namespace delray::composite {
namespace {

DeepImage<image::RgbaF> random_image(std::mt19937& random, int width, int height, unsigned rank) {
  DeepImage<image::RgbaF> image(width, height);
  for (std::size_t i = 0; i < image.lists.size(); ++i) {
    if (i / 512 % 4 == rank) continue;  // longer runs of nothing
    std::vector<Fragment> list;
    for (unsigned k = random() % 3; k > 0; --k) {
      const float alpha = random() % 3 == 0 ? 1.0F : 0.5F;
      list.push_back({{0, 0, 0, alpha}, static_cast<float>(random() % 3), 4 * k + rank, rank});
    }
    if (!list.empty()) image.set(i, list);
  }
  return image;
}

void expect_same(const DeepShape& shape, const DeepImage<image::RgbaF>& image, PixelRange range) {
  std::vector<DeepShape::Pixel> pixels;
  std::vector<DeepShape::Surface> surfaces;
  shape.read(range, pixels, surfaces);
  auto pixel = pixels.begin();
  auto surface = surfaces.begin();
  for (std::uint64_t i = range.begin; i < range.end; ++i) {
    const auto list = image.at(i);
    if (list.empty()) continue;
    ASSERT_NE(pixel, pixels.end());
    ASSERT_EQ(pixel->index, i - range.begin);
    ASSERT_EQ(pixel++->size, list.size());
    for (const Fragment& fragment : list) {
      ASSERT_EQ(surface->depth, fragment.depth);
      ASSERT_EQ(surface->primitive(), fragment.primitive());
      ASSERT_EQ(is_opaque(surface++->payload), is_opaque(fragment.payload));
    }
  }
  EXPECT_EQ(pixel, pixels.end());
  EXPECT_EQ(surface, surfaces.end());
}

TEST(DeepShape, ChangesAsADeepLayerDoes) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const int width = 1 + static_cast<int>(random() % 150), height = 90;
    DeepLayer<image::RgbaF> layer(random_image(random, width, height, 0));
    DeepShape shape(layer.image());
    const DeepShape first = shape;
    for (unsigned rank = 1; rank < 4; ++rank) {
      DeepLayer<image::RgbaF> other(random_image(random, width, height, rank));
      const DeepShape other_shape(other.image());
      std::uint64_t begin = random() % layer.pixels(), end = random() % layer.pixels();
      if (begin > end) std::swap(begin, end);
      const PixelRange range{begin, end};
      std::vector<DeepShape::Pixel> pixels;
      std::vector<DeepShape::Surface> surfaces;
      other_shape.read(range, pixels, surfaces);
      if (rank == 2) {
        layer.replace(range, other.encode(range));
        shape.remove(range);
        shape.merge(range, {pixels, surfaces});
      } else {
        EXPECT_EQ(shape.merge(range, {pixels, surfaces}),
                  layer.merge(range, other.encode(range), Side::higher));
      }
      expect_same(shape, layer.image(), {0, layer.pixels()});
      expect_same(shape, layer.image(), range);
    }
    // Copies do not change with it.
    std::mt19937 again(seed);
    again();
    expect_same(first, random_image(again, width, height, 0), {0, layer.pixels()});
    shape.remove({0, layer.pixels()});
    EXPECT_TRUE(shape.empty());
    EXPECT_FALSE(first.empty());
  }
  EXPECT_TRUE(DeepShape(0).empty());
}

}  // namespace
}  // namespace delray::composite
