#include "raster/internal/shade_gouraud.h"

#include <gtest/gtest.h>

#include <random>

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
      const std::uint16_t runs[] = {0, kNoTriangle, 0};
      image::Rgba8 pixels[kBlockSize];
      shade_row({&flat, 1}, 7, runs, 5, 7, 3, pixels);
      const std::uint8_t code = image::encode_srgb(colour);
      ASSERT_EQ(pixels[0], (image::Rgba8{code, 0, code, 255})) << colour;
      ASSERT_EQ(pixels[1], image::Rgba8());
      ASSERT_EQ(pixels[2], pixels[0]);
    }
  });
}

}  // namespace
}  // namespace delray::raster
