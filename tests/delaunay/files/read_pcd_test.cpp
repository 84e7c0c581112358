// PCD files of all encodings and types of fields, and what is refused.
#include "delaunay/read_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "tests/delaunay/files/parts/lzf_encoder.h"
#include "tests/delaunay/files/point_files.h"

namespace delray::delaunay {
namespace {

using tests::append_bytes;
using tests::complaint_about_points;
using tests::points_in;

std::string pcd(const std::string& fields, const std::string& sizes, const std::string& types,
                std::size_t points, const std::string& encoding) {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " +
         sizes + "\nTYPE " + types + "\nWIDTH " + std::to_string(points) +
         "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(points) + "\nDATA " +
         encoding + "\n";
}

TEST(ReadPcd, ReadsTheSameInEveryEncoding) {
  constexpr unsigned kSeed = 20044;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  for (const std::size_t points : {1U, 2U, 1000U, 66000U}) {
    std::string ascii, binary, columns[6];
    for (std::size_t i = 0; i < points; ++i) {
      const auto x = static_cast<float>(random() % 1000) / 8;
      const double y = static_cast<double>(random() % 100000) / 16;
      const auto z = static_cast<std::int16_t>(random() % 65536);
      const std::uint32_t rgb = random() % (1U << 24);
      const auto intensity = static_cast<std::uint8_t>(random() % 256);
      const auto kind = static_cast<std::uint8_t>(random() % 20);
      for (const std::string& word : {std::to_string(x), std::to_string(y), std::to_string(z),
                                      std::to_string(rgb), std::to_string(intensity)}) {
        ascii += word + " ";
      }
      ascii += std::to_string(kind) + "\n";
      const auto put = [&](int column, auto value) {
        append_bytes(binary, value);
        append_bytes(columns[column], value);
      };
      put(0, x);
      put(1, y);
      put(2, z);
      put(3, rgb);
      put(4, intensity);
      put(5, kind);
    }
    const auto header = [&](const std::string& encoding) {
      return pcd("x y z rgb intensity classification", "4 8 2 4 1 1", "F F I U U U", points,
                 encoding);
    };
    std::string all;
    for (const std::string& column : columns) all += column;
    const std::string packed = tests::pack_lzf(all);
    std::string sizes;
    append_bytes(sizes, static_cast<std::uint32_t>(packed.size()));
    append_bytes(sizes, static_cast<std::uint32_t>(all.size()));
    const PointCloud text = points_in("a.pcd", header("ascii") + ascii),
                     records = points_in("a.pcd", header("binary") + binary),
                     compressed = points_in("a", header("binary_compressed") + sizes + packed);
    EXPECT_EQ(text.size(), points);
    for (const PointCloud* other : {&records, &compressed}) {
      EXPECT_TRUE(text.positions == other->positions);
      EXPECT_TRUE(text.colours == other->colours);
      EXPECT_TRUE(text.intensity == other->intensity);
      EXPECT_TRUE(text.classification == other->classification);
    }
  }
}

TEST(ReadPcd, ReadsColoursThatAreBytesOfAFloat) {
  std::string binary = pcd("rgb x y", "4 4 4", "F F F", 1, "binary");
  append_bytes(binary, std::uint32_t{0x00ff8001});
  append_bytes(binary, 1.5F);
  append_bytes(binary, 2.5F);
  const PointCloud cloud = points_in("a.pcd", binary);
  EXPECT_FALSE(cloud.has_z);
  EXPECT_EQ(cloud.positions[0], glm::dvec3(1.5, 2.5, 0));
  EXPECT_EQ(cloud.colours[0], glm::u8vec4(255, 128, 1, 255));
}

TEST(ReadPcd, LeavesOutPointsWithoutCoordinates) {
  const PointCloud cloud = points_in("a.pcd", pcd("x y z", "4 4 4", "F F F", 4, "ascii") +
                                                  "1 2 3\nnan nan nan\n-inf 0 0\n\n4 5 6\n");
  EXPECT_EQ(cloud.positions, (std::vector<glm::dvec3>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(cloud.warnings, (std::vector<std::string>{"2 points without coordinates left out"}));
  EXPECT_NE(complaint_about_points("a.pcd", pcd("x y", "4 4", "F F", 1, "ascii") + "nan 0\n")
                .find("no points"),
            std::string::npos);
}

TEST(ReadPcd, RefusesWhatCannotBe) {
  const auto refused = [](const std::string& content, const char* text) {
    EXPECT_NE(complaint_about_points("a.pcd", content).find(text), std::string::npos) << content;
  };
  const std::string numbers(24, '\0');
  refused(pcd("x y", "4 4", "F F", 1000, "binary") + numbers, "more than the file holds");
  refused(pcd("x y", "4 4", "F F", 1UL << 47, "binary") + numbers, "more than the file holds");
  refused(pcd("x y", "4 4", "F F", 1UL << 50, "binary"), "line 6");
  refused(pcd("x y", "4 4", "F F", 2, "binary_compressed") + numbers, "sizes of the compressed");
  refused(pcd("x y", "4 4", "F F", 2, "packed") + numbers, "DATA is neither");
  refused(pcd("x z", "4 4", "F F", 2, "binary") + numbers, "no x or no y");
  refused(pcd("x y", "4 3", "F U", 2, "binary") + numbers, "3 bytes is not known");
  refused(pcd("x y", "4", "F F", 2, "binary") + numbers, "line 4: has fewer values");
  refused(pcd("x y", "4 9", "F F", 2, "binary") + numbers, "line 4: not a number from 1 to 8");
  refused("# .PCD\nFIELDS x y\nNOTE\n", "line 3: not a line of a PCD header");
  refused("# .PCD\nFIELDS x y\n", "has no DATA");
  refused(pcd("x y", "4 4", "F F", 2, "ascii") + "1 2\n3\n", "line 12: the line ends too early");
  refused(pcd("x y", "4 4", "F F", 3, "ascii") + "1 2\n3 4\n",
          "the header announces 3 points, the file has 2 lines of them");
  refused(pcd("x y", "4 4", "F F", 2, "ascii") + "1 2\n3 x\n", "line 12: not a number");
  std::string damaged = pcd("x y", "4 4", "F F", 2, "binary_compressed");
  append_bytes(damaged, std::uint32_t{4});
  append_bytes(damaged, std::uint32_t{16});
  refused(damaged + "\xff\xff\xff\xff", "are damaged");
}

}  // namespace
}  // namespace delray::delaunay
