#include "raster/shading/shade_gouraud.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <numeric>
#include <random>
#include <span>
#include <vector>

#include "image/srgb.h"
#include "tests/raster/shade_both_ways.h"

namespace delray::raster {
namespace {

TEST(ShadeGouraud, GivesWhatPixelByPixelGives) {
  expect_vectors_give_what_pixels_give<GouraudTile>(Lighting::gouraud);
}

TEST(ShadeGouraud, ColoursOfSurfacesAreThoseOfEachAlone) {
  expect_colours_of_each_alone<GouraudTile>(Lighting::gouraud);
}

// Triangles of the first cluster have their numbers as indices.
constexpr std::array<std::uint16_t, 1> kFirstGroup = {0};
const std::vector<std::uint16_t> kOwnNumbers = [] {
  std::vector<std::uint16_t> numbers(kClusterTriangles);
  std::iota(numbers.begin(), numbers.end(), std::uint16_t{0});
  return numbers;
}();
const TriangleIndices kSameIndices{kFirstGroup.data(), kOwnNumbers.data()};

// However long runs are, a pixel is shaded as it is alone.
template <class Colour>
void expect_rows_of_single_pixels(std::mt19937& random, std::span<const PixelTriangle> triangles) {
  const int count = 1 + static_cast<int>(random() % kTileSize);
  const std::uint32_t longest = 1 + static_cast<std::uint32_t>(random()) % 20;
  std::uint32_t numbers[kTileSize] = {};
  std::uint64_t starts = 0, shown = 0;
  for (int i = 0, next = 0; i < kTileSize; ++i) {
    const bool start = i == next;
    if (start) next += 1 + static_cast<int>(random() % longest);
    numbers[i] = !start              ? numbers[i - 1]
                 : random() % 4 == 0 ? kNothing
                                     : static_cast<std::uint32_t>(random() % triangles.size());
    starts |= std::uint64_t{start} << i;
    shown |= std::uint64_t{numbers[i] != kNothing} << i;
  }
  const int x = static_cast<int>(random() % 1000), y = static_cast<int>(random() % 1000);
  Colour row[kTileSize + kBlockSize], alone[kBlockSize];
  shade_row(triangles, kSameIndices, {starts, shown, numbers}, x, y, count, row);
  for (int i = 0; i < count; ++i) {
    shade_row(triangles, kSameIndices, {1, shown >> i, numbers + i}, x + i, y, 1, alone);
    ASSERT_EQ(std::memcmp(&row[i], &alone[0], sizeof(Colour)), 0) << i << " of " << count;
  }
}

TEST(ShadeGouraud, RowsOfShortAndLongRunsAreThoseOfTheirPixels) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<PixelTriangle> triangles(9);
  for (PixelTriangle& t : triangles) {
    for (int k = 0; k < 4; ++k) {
      t.a[k] = unit(random) / 4000;
      t.b[k] = unit(random) / 4000;
      t.c[k] = 1 + unit(random);
    }
    t.x = static_cast<float>(random() % 1000);
    t.y = static_cast<float>(random() % 1000);
  }
  tests::for_each_target([&] {
    for (int round = 0; round < 50; ++round) {
      expect_rows_of_single_pixels<image::Rgba8>(random, triangles);
      expect_rows_of_single_pixels<image::RgbaF>(random, triangles);
    }
  });
}

TEST(ShadeGouraud, RowsEncodeEveryColourAsPixelsDo) {
  // Colours around every step of the code, and those that are none.
  std::vector<float> colours = {0.0F, -1.0F, 1.0F, 2.0F, 1e30F, 1e-30F, 0x1p-13F};
  for (int code = 1; code < 256; ++code) {
    const float least = image::internal::kLeastOfCode[static_cast<std::size_t>(code)];
    colours.push_back(least);
    colours.push_back(std::nextafter(least, 0.0F));
    colours.push_back(std::nextafter(least, 1.0F));
  }
  std::mt19937 random(6);
  std::uniform_real_distribution<float> unit(0, 1);
  for (int i = 0; i < 5000; ++i) colours.push_back(unit(random) * unit(random));
  tests::for_each_target([&] {
    for (const float colour : colours) {
      PixelTriangle flat{};
      flat.c[0] = flat.c[2] = colour;
      flat.c[3] = 1;
      const std::uint32_t numbers[] = {0, kNothing, 0};
      image::Rgba8 pixels[kBlockSize];
      shade_row({&flat, 1}, kSameIndices, {7, 5, numbers}, 5, 7, 3, pixels);
      const std::uint8_t code = image::encode_srgb(colour);
      ASSERT_EQ(pixels[0], (image::Rgba8{code, 0, code, 255})) << colour;
      ASSERT_EQ(pixels[1], image::Rgba8());
      ASSERT_EQ(pixels[2], pixels[0]);
    }
  });
}

}  // namespace
}  // namespace delray::raster
