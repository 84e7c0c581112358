// Points in PLY files of every encoding, and the vertices that messages name.
#include "delaunay/read_points.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "tests/delaunay/files/point_files.h"

namespace delray::delaunay {
namespace {

using tests::append_bytes;
using tests::complaint_about_points;
using tests::ply_of_points;
using tests::points_in;
using Positions = std::vector<glm::dvec3>;

TEST(ReadPly, ReadsPlyOfEveryEncoding) {
  for (const char* encoding : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    for (const bool lists : {false, true}) {
      SCOPED_TRACE(std::string(encoding) + (lists ? " with lists" : ""));
      const PointCloud cloud = points_in("a.ply", ply_of_points(encoding, lists));
      EXPECT_TRUE(cloud.has_z);
      EXPECT_EQ(cloud.positions, (Positions{{0.1, 0, 0.5}, {0.1, -1, 0.5}, {0.1, -2, 0.5}}));
      EXPECT_EQ(cloud.colours[2], glm::u8vec4(254, 7, 2, 255));
      EXPECT_EQ(cloud.intensity, (std::vector<float>{1, 1, 1}));
    }
  }
}

TEST(ReadPly, ReadsPlyWhoseBodyBeginsLikeALineAndWhoseFirstLineEndsWithABlank) {
  for (const char* line_end : {"\n", "\r\n", " \n", "\t\r\n"}) {
    std::string text;
    for (const char* line : {"ply", "format binary_big_endian 1.0", "element vertex 2",
                             "property short x", "property short y", "end_header"}) {
      text += line + (text.empty()                  ? std::string(line_end)
                      : std::strchr(line_end, '\r') ? "\r\n"
                                                    : "\n");
    }
    for (const std::int16_t x : {0x0A0D, 0x0D0A, 0x0A0A, 1}) append_bytes(text, x, true);
    EXPECT_EQ(points_in("a.ply", text).positions, (Positions{{0x0A0D, 0x0D0A, 0}, {0x0A0A, 1, 0}}));
  }
}

TEST(ReadPly, WidensFloatsOfPlyExactly) {
  std::string text =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\n"
      "property float y\nend_header\n";
  append_bytes(text, 0.1F);
  append_bytes(text, std::numeric_limits<float>::denorm_min());
  const PointCloud cloud = points_in("a.ply", text);
  EXPECT_FALSE(cloud.has_z);
  EXPECT_EQ(cloud.positions[0],
            glm::dvec3(double{0.1F}, double{std::numeric_limits<float>::denorm_min()}, 0));
}

TEST(ReadPly, NamesTheVertexOfBadPly) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    std::string text =
        "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty float x\n"
        "property float y\nend_header\n";
    for (int i = 0; i < 6; ++i) append_bytes(text, i == 3 ? bad : 1.0F, true);
    EXPECT_NE(complaint_about_points("a.ply", text).find("vertex 1"), std::string::npos);
  }
  const std::string header = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n";
  EXPECT_NE(complaint_about_points("a.ply", header + "property float y\nend_header\n1 nan\n")
                .find("line 7"),
            std::string::npos);
  complaint_about_points("a.ply", header + "end_header\n1\n");
  complaint_about_points("a.ply", header + "property strange y\nend_header\n1 1\n");
  complaint_about_points("a.ply", header + "property list float int y\nend_header\n1 1\n");
  complaint_about_points(
      "a.ply", "ply\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n1 1\n");
}

}  // namespace
}  // namespace delray::delaunay
