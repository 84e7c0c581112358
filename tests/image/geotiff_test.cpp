#include "image/geotiff.h"

#include <gtest/gtest.h>

#include "tests/support/geotiff_file.h"
#include "tests/support/temporary_folder.h"

namespace delray::image {
namespace {

using tests::GeoTiffFile;

TEST(GeoTiff, TellsOriginAndCellSizeInEveryByteOrder) {
  const tests::TemporaryFolder folder;
  for (const bool big_endian : {false, true}) {
    for (const bool big_tiff : {false, true}) {
      GeoTiffFile file{.big_endian = big_endian, .big_tiff = big_tiff};
      file.scale = {2, 0.5, 0};
      file.tie = {1, 1, 0, 500000, 4649776, 0};
      file.no_data = "-9999";
      const GeoTiff found = read_geotiff(folder.write("a.tif", file.bytes()));
      ASSERT_TRUE(found.to_ground);
      EXPECT_EQ((*found.to_ground)[0], glm::dvec2(2, 0));
      EXPECT_EQ((*found.to_ground)[1], glm::dvec2(0, -0.5));
      // Coordinates are those of corners: the centre is half a pixel to the right and below.
      EXPECT_EQ((*found.to_ground)[2], glm::dvec2(499998 + 1, 4649776.5 - 0.25));
      EXPECT_EQ(found.no_data, -9999);
      EXPECT_FALSE(found.geographic);
      file.pixel_is_point = true;
      file.geographic = true;
      const GeoTiff point = read_geotiff(folder.write("b.tif", file.bytes()));
      ASSERT_TRUE(point.to_ground);
      EXPECT_EQ((*point.to_ground)[2], glm::dvec2(499998, 4649776.5));
      EXPECT_TRUE(point.geographic);
    }
  }
}

TEST(GeoTiff, KnowsNothingOfOtherAndBrokenFiles) {
  const tests::TemporaryFolder folder;
  EXPECT_FALSE(read_geotiff(folder.write("a.png", "\x89PNG")).to_ground);
  EXPECT_FALSE(read_geotiff(folder.path() / "none.tif").to_ground);
  GeoTiffFile file;
  EXPECT_FALSE(read_geotiff(folder.write("plain.tif", file.bytes())).to_ground);
  file.scale = {0, 0, 0};  // pixels without size
  file.tie = {0, 0, 0, 1, 2, 0};
  EXPECT_FALSE(read_geotiff(folder.write("flat.tif", file.bytes())).to_ground);
  file.scale = {1, 1, 0};
  const std::string whole = file.bytes();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    read_geotiff(folder.write("cut.tif", whole.substr(0, size)));
  }
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string damaged = whole;
    damaged[i] = '\xff';
    read_geotiff(folder.write("damaged.tif", damaged));
  }
}

}  // namespace
}  // namespace delray::image
