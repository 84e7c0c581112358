#include "image/jpeg.h"

#include <gtest/gtest.h>

#include <cmath>

#include "image/io.h"

namespace delray::image {
namespace {

Image8 gradient(int width, int height) {
  Image8 image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.colour[static_cast<std::size_t>(y * width + x)] = {
          static_cast<std::uint8_t>(x * 255 / width), static_cast<std::uint8_t>(y * 255 / height),
          100, 255};
    }
  }
  return image;
}

TEST(Jpeg, IsThePictureButForWhatItsQualityLoses) {
  for (const auto& [width, height] : {std::pair{1, 1}, {17, 3}, {64, 48}, {301, 7}}) {
    const Image8 image = gradient(width, height);
    for (const int quality : {80, 95}) {
      const Texels read = decode_image8(encode_jpeg(image, quality), "jpeg");
      ASSERT_EQ(read.width, width);
      ASSERT_EQ(read.height, height);
      double sum = 0;
      for (std::size_t i = 0; i < image.pixels(); ++i)
        sum += std::abs(read.texels[i].r - image.colour[i].r) +
               std::abs(read.texels[i].g - image.colour[i].g) +
               std::abs(read.texels[i].b - image.colour[i].b);
      // Steep colours of small pictures lose most where they have half of the resolution.
      EXPECT_LT(sum / (3.0 * static_cast<double>(image.pixels())), quality < 90 ? 20 : 6)
          << width << " " << quality;
    }
  }
}

TEST(Jpeg, IsTheSameEveryTimeAndSmallerWithLessQuality) {
  const Image8 image = gradient(128, 64);
  EXPECT_EQ(encode_jpeg(image, 80), encode_jpeg(image, 80));
  EXPECT_LT(encode_jpeg(image, 30).size(), encode_jpeg(image, 95).size());
}

}  // namespace
}  // namespace delray::image
