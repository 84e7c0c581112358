#include "image/write_geotiff.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <vector>

#include "files/error.h"
#include "image/geotiff.h"
#include "image/io.h"
#include "tests/support/temporary_folder.h"

namespace delray::image {
namespace {

constexpr std::uint64_t kWidth = 300, kHeight = 70;

GeoRaster small_raster() {
  GeoRaster raster;
  raster.width = kWidth;
  raster.height = kHeight;
  raster.west = 1000;
  raster.north = 2000;
  raster.cell = 0.5;
  raster.block = 64;
  return raster;
}

std::string write(const std::filesystem::path& path, const GeoRaster& raster) {
  GeoTiffWriter writer(path, raster);
  const auto block = static_cast<std::uint64_t>(raster.block);
  std::vector<float> pixels(block * block);
  for (std::uint64_t row = 0; row < (raster.height + block - 1) / block; ++row) {
    for (std::uint64_t column = 0; column < (raster.width + block - 1) / block; ++column) {
      for (std::uint64_t i = 0; i < pixels.size(); ++i) {
        pixels[i] =
            static_cast<float>((row * block + i / block) * 1000 + column * block + i % block);
      }
      writer.write_block(column, row, pixels);
    }
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  writer.commit();
  return writer.warning();
}

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return (std::ostringstream() << file.rdbuf()).str();
}

TEST(WriteGeoTiff, ReadsBack) {
  const tests::TemporaryFolder folder;
  EXPECT_EQ(write(folder / "a.tif", small_raster()), "");
  EXPECT_EQ(folder.entries(), 1U);
  const RawChannels picture = read_float_channels(folder / "a.tif");
  ASSERT_EQ(picture.width, static_cast<int>(kWidth));
  ASSERT_EQ(picture.height, static_cast<int>(kHeight));
  for (std::size_t y = 0; y < kHeight; ++y) {
    for (std::size_t x = 0; x < kWidth; ++x) {
      EXPECT_EQ(picture.values[y * kWidth + x], static_cast<double>(y * 1000 + x));
    }
  }
  const GeoTiff ground = read_geotiff(folder / "a.tif");
  ASSERT_TRUE(ground.to_ground);
  EXPECT_EQ((*ground.to_ground)[0], glm::dvec2(0.5, 0));
  EXPECT_EQ((*ground.to_ground)[1], glm::dvec2(0, -0.5));
  EXPECT_EQ((*ground.to_ground)[2], glm::dvec2(1000.25, 1999.75));
  EXPECT_EQ(ground.no_data, -9999);
}

TEST(WriteGeoTiff, TellsTheCoordinateSystem) {
  const tests::TemporaryFolder folder;
  GeoRaster raster = small_raster();
  raster.coordinate_system.well_known_text =
      "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563]],"
      "PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]]";
  EXPECT_EQ(write(folder / "text.tif", raster), "");
  EXPECT_TRUE(read_geotiff(folder / "text.tif").geographic);
  // The keys of a geographic system: model type, raster type, EPSG 4326.
  raster.coordinate_system = {};
  raster.coordinate_system.geo_keys = {1, 1, 0, 3, 1024, 0, 1, 2, 1025, 0, 1, 1, 2048, 0, 1, 4326};
  EXPECT_EQ(write(folder / "keys.tif", raster), "");
  EXPECT_TRUE(read_geotiff(folder / "keys.tif").geographic);
  raster.coordinate_system = {};
  raster.coordinate_system.raster = folder / "keys.tif";
  EXPECT_EQ(write(folder / "copied.tif", raster), "");
  EXPECT_TRUE(read_geotiff(folder / "copied.tif").geographic);
  EXPECT_EQ(content(folder / "copied.tif"), content(folder / "keys.tif"));
}

TEST(WriteGeoTiff, GoesWithoutACoordinateSystemThatIsNone) {
  const tests::TemporaryFolder folder;
  GeoRaster raster = small_raster();
  int i = 0;
  for (const std::string text : {"PROJCS[", "/etc/passwd", "EPSG:4326x", "\xff\xfe"}) {
    raster.coordinate_system.well_known_text = text;
    EXPECT_NE(write(folder / ("a" + std::to_string(i++) + ".tif"), raster), "") << text;
  }
}

TEST(WriteGeoTiff, LeavesNothingOfWhatIsNotCommitted) {
  const tests::TemporaryFolder folder;
  { GeoTiffWriter writer(folder / "a.tif", small_raster()); }
  EXPECT_EQ(folder.entries(), 0U);
  EXPECT_THROW(GeoTiffWriter(folder / "none/a.tif", small_raster()), files::FileError);
}

}  // namespace
}  // namespace delray::image
