// Pictures that are written from top to bottom.
#include "image/picture_rows.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "files/error.h"
#include "image/hash.h"
#include "image/srgb.h"
#include "tests/image/picture_folder.h"

namespace delray::image {
namespace {

using PictureRowsInFiles = tests::PictureFolder;

template <class Image>
Image rows_of(const Image& image, int begin, int end) {
  Image rows(image.width, end - begin);
  const std::size_t first = static_cast<std::size_t>(begin) * static_cast<std::size_t>(image.width);
  std::copy_n(image.colour.data() + first, rows.pixels(), rows.colour.data());
  std::copy_n(image.depth.data() + first, rows.pixels(), rows.depth.data());
  return rows;
}

ImageF random_image(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  ImageF image(width, height);
  for (std::size_t i = 0; i < image.pixels(); ++i) {
    const float a = i % 3 == 0 ? 1.0F : unit(random);
    image.colour[i] = {a * unit(random), a * unit(random), a * unit(random), a};
    image.depth[i] = 1 + unit(random);
  }
  return image;
}

// Whatever parts the rows come in, the file reads as the one that is written at once.
TEST_F(PictureRowsInFiles, AreThePictureWrittenAtOnce) {
  std::mt19937 random(3);
  for (const char* suffix : {".exr", ".tif"}) {
    for (const int height : {1, 127, 128, 129, 300}) {
      const ImageF image = random_image(150, height, static_cast<unsigned>(height));
      const auto whole = path("whole" + std::string(suffix));
      const auto file = path("rows" + std::string(suffix));
      const bool is_exr = std::string(suffix) == ".exr";
      const Image8 codes = to_8bit(image);
      PictureHash hashed;
      PictureRows rows(file, image.width, height);
      for (int y = 0; y < height;) {
        const int end = std::min(height, y + 1 + static_cast<int>(random() % 200));
        hashed.append(rows_of(codes, y, end));
        if (is_exr)
          rows.append(rows_of(image, y, end));
        else
          rows.append(rows_of(codes, y, end));
        y = end;
      }
      EXPECT_FALSE(std::filesystem::exists(file));
      rows.commit();
      write_image(whole, image);
      const ImageF a = read_image_float(whole), b = read_image_float(file);
      ASSERT_EQ(a.width, b.width);
      ASSERT_EQ(a.height, b.height);
      for (std::size_t i = 0; i < a.pixels(); ++i) {
        ASSERT_EQ(a.colour[i], b.colour[i]) << i;
        if (is_exr) {
          ASSERT_EQ(a.depth[i], b.depth[i]) << i;
        }
      }
      EXPECT_EQ(hashed.text(), hash(codes));
      std::filesystem::remove(file);
    }
  }
}

TEST_F(PictureRowsInFiles, LeaveNothingWithoutACommit) {
  {
    PictureRows rows(path("half.tif"), 10, 10);
    rows.append(to_8bit(random_image(10, 5, 1)));
  }
  EXPECT_EQ(files(), 0U);
  EXPECT_THROW(PictureRows(path("no") / "such.tif", 10, 10), files::FileError);
}

TEST(PictureRows, AreForTiledFormats) {
  EXPECT_TRUE(is_written_in_rows("a.tif"));
  EXPECT_TRUE(is_written_in_rows("a.TIFF"));
  EXPECT_TRUE(is_written_in_rows("a.exr"));
  EXPECT_FALSE(is_written_in_rows("a.png"));
  EXPECT_FALSE(is_written_in_rows("a.jpg"));
  EXPECT_FALSE(is_written_in_rows("-"));
}

}  // namespace
}  // namespace delray::image
