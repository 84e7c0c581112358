// Points in LAS files of every version and format, their coordinates, and what is refused.
#include "delaunay/read_points.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "tests/delaunay/files/point_files.h"

namespace delray::delaunay {
namespace {

using tests::append_bytes;
using tests::complaint_about_points;
using tests::las_of_points;
using tests::points_in;
using Positions = std::vector<glm::dvec3>;

TEST(ReadLas, ReadsLasOfEveryVersionAndPointFormat) {
  constexpr std::array<std::array<std::size_t, 2>, 11> kFormats = {{{20, 0},
                                                                    {28, 0},
                                                                    {26, 20},
                                                                    {34, 28},
                                                                    {57, 0},
                                                                    {63, 28},
                                                                    {30, 0},
                                                                    {36, 30},
                                                                    {38, 30},
                                                                    {59, 0},
                                                                    {67, 30}}};
  for (unsigned format = 0; format < kFormats.size(); ++format) {
    for (const int minor : {0, 1, 2, 3, 4}) {
      SCOPED_TRACE(format);
      const auto [record, colour] = kFormats[format];
      const PointCloud cloud =
          points_in("a.las", las_of_points(minor, format, record + minor, colour));
      EXPECT_EQ(cloud.positions, (Positions{{-2, 998.25, 1998.5}, {-1, 999.25, 1999.5}}));
      EXPECT_EQ(cloud.intensity, (std::vector<float>{0, 1}));
      const std::uint8_t kind = format < 6 ? 6 : 66;
      EXPECT_EQ(cloud.classification, (std::vector<std::uint8_t>{kind, kind}));
      ASSERT_EQ(cloud.colours.size(), colour > 0 ? 2U : 0U);
      if (colour > 0) {
        EXPECT_EQ(cloud.colours[0], glm::u8vec4(1, 2, 3, 255));
        EXPECT_EQ(cloud.colours[1], glm::u8vec4(80, 160, 240, 255));
      }
    }
  }
}

// The same with a record of the group LASF_Projection between header and points.
std::string las_with_projection(std::uint16_t number, const std::string& content) {
  std::string bytes = las_of_points(2, 3, 34, 28);
  std::string record(54, '\0');
  record.replace(2, 15, "LASF_Projection");
  const auto length = static_cast<std::uint16_t>(content.size());
  std::memcpy(&record[18], &number, sizeof number);
  std::memcpy(&record[20], &length, sizeof length);
  record += content;
  const std::uint16_t header = 227;
  const std::uint32_t records = 1, begin = 227 + static_cast<std::uint32_t>(record.size());
  std::memcpy(&bytes[94], &header, sizeof header);
  std::memcpy(&bytes[96], &begin, sizeof begin);
  std::memcpy(&bytes[100], &records, sizeof records);
  return bytes.substr(0, header) + record + bytes.substr(header);
}

TEST(ReadLas, KnowsDegrees) {
  const auto keys = [](std::uint16_t model) {
    std::string directory;
    for (const int value : {1, 1, 0, 1, 1024, 0, 1, int{model}})
      append_bytes(directory, static_cast<std::uint16_t>(value));
    return directory;
  };
  EXPECT_TRUE(points_in("a.las", las_with_projection(34735, keys(2))).geographic);
  EXPECT_FALSE(points_in("a.las", las_with_projection(34735, keys(1))).geographic);
  EXPECT_TRUE(points_in("a.las", las_with_projection(2112, "GEOGCS[\"WGS 84\"]")).geographic);
  EXPECT_FALSE(
      points_in("a.las", las_with_projection(2112, "PROJCS[\"x\",GEOGCS[\"WGS 84\"]]")).geographic);
  EXPECT_FALSE(points_in("a.las", las_with_projection(34735, "")).geographic);
  // Without a word steps tell, but not where a projection is told.
  const auto in_fine_steps = [](std::string bytes) {
    for (int k = 0; k < 3; ++k) {
      const double step = k == 2 ? 0.01 : 1e-7, offset = 10.0 + k;
      std::memcpy(&bytes[131 + 8 * k], &step, sizeof step);
      std::memcpy(&bytes[155 + 8 * k], &offset, sizeof offset);
    }
    return bytes;
  };
  EXPECT_TRUE(points_in("a.las", in_fine_steps(las_of_points(2, 3, 34, 28))).geographic);
  EXPECT_FALSE(points_in("a.las", in_fine_steps(las_with_projection(34735, keys(1)))).geographic);
  EXPECT_FALSE(points_in("a.las", las_of_points(2, 3, 34, 28)).geographic);
  EXPECT_TRUE(points_in("a.csv", "Longitude,Latitude,height\n1,2,3\n").geographic);
  EXPECT_FALSE(points_in("a.csv", "lon,y,height\n1,2,3\n").geographic);
  EXPECT_FALSE(points_in("a.csv", "1,2,3\n").geographic);
}

TEST(ReadLas, RefusesBrokenLas) {
  const std::string good = las_of_points(2, 3, 34, 28);
  const auto with = [&](std::size_t at, auto value) {
    std::string bytes = good;
    std::memcpy(&bytes[at], &value, sizeof value);
    return bytes;
  };
  EXPECT_NE(complaint_about_points("a.las", with(104, std::uint8_t{3 | 128})).find("LAZ"),
            std::string::npos);
  EXPECT_NE(complaint_about_points("a.laz", with(104, std::uint8_t{3 | 64})).find("LAZ"),
            std::string::npos);
  complaint_about_points("a.las", with(104, std::uint8_t{11}));
  complaint_about_points("a.las", with(105, std::uint16_t{33}));
  complaint_about_points("a.las", with(107, std::uint32_t{3}));
  complaint_about_points("a.las", with(107, std::uint32_t{0xffffffff}));
  complaint_about_points("a.las", with(96, std::uint32_t{0xffffffff}));
  for (const std::uint32_t begin : {0U, 4U, 226U}) {
    EXPECT_NE(complaint_about_points("a.las", with(96, begin))
                  .find("byte 96: points cannot begin inside"),
              std::string::npos);
  }
  EXPECT_NE(complaint_about_points("a.las", with(94, std::uint16_t{0})).find("byte 94"),
            std::string::npos);
  complaint_about_points("a.las", with(24, std::uint8_t{2}));
  complaint_about_points("a.las", with(25, std::uint8_t{5}));
  complaint_about_points("a.las", with(131, std::numeric_limits<double>::quiet_NaN()));
  complaint_about_points("a.las", with(155, std::numeric_limits<double>::infinity()));
  complaint_about_points("a.las", with(131, 1e308));
  EXPECT_NE(complaint_about_points("a.las", with(107, std::uint32_t{0})).find("no points"),
            std::string::npos);
  std::string las14 = las_of_points(4, 6, 30, 0);
  const std::uint64_t huge = std::uint64_t{1} << 60;
  std::memcpy(&las14[247], &huge, sizeof huge);
  complaint_about_points("a.las", las14);
}

}  // namespace
}  // namespace delray::delaunay
