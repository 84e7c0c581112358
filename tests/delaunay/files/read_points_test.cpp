// Point readers: the smaller formats, and damage to files of any format.
#include "delaunay/read_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "files/error.h"
#include "tests/delaunay/files/point_files.h"

namespace delray::delaunay {
namespace {

using files::Cause;
using files::FileError;
using tests::append_bytes;
using tests::complaint_about_points;
using tests::las_of_points;
using tests::ply_of_points;
using tests::points_in;
using Positions = std::vector<glm::dvec3>;

TEST(ReadPoints, TakesLineEndsOfEveryKind) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n";
  std::string binary = header;
  binary.replace(binary.find("ascii"), 5, "binary_little_endian");
  for (const char* end : {"\r", "\r\n"}) {
    const auto converted = [end](const std::string& text) {
      std::string result;
      for (const char c : text) result += c == '\n' ? std::string(end) : std::string(1, c);
      return result;
    };
    for (const auto& [name, text] :
         std::vector<std::pair<std::string, std::string>>{{"a.xyz", "1 2 3\n4 5 6\n"},
                                                          {"a.csv", "x,y,z\n1,2,3\n4,5,6\n"},
                                                          {"a.obj", "v 1 2 3\nv 4 5 6\n"},
                                                          {"a.off", "OFF\n2 0 0\n1 2 3\n4 5 6\n"},
                                                          {"a.node", "2 3 0 0\n1 1 2 3\n2 4 5 6\n"},
                                                          {"a.ply", header + "1 2 3\n4 5 6\n"}}) {
      EXPECT_EQ(points_in(name, converted(text)).positions, (Positions{{1, 2, 3}, {4, 5, 6}}))
          << name << (end[1] == 0 ? " with CR" : " with CR LF");
    }
    std::string bytes = converted(binary);
    // A body with bytes that look like line ends.
    for (const float x : {std::bit_cast<float>(0x3f0d0d0dU), 2.0F, 3.0F, 4.0F, 5.0F, 6.0F}) {
      append_bytes(bytes, x);
    }
    if (end[1] == 0) {
      const PointCloud cloud = points_in("a.ply", bytes);
      EXPECT_EQ(cloud.positions[0].x, double{std::bit_cast<float>(0x3f0d0d0dU)});
      EXPECT_EQ(cloud.positions[1], glm::dvec3(4, 5, 6));
    }
  }
}

TEST(ReadPoints, RefusesFilesWithoutPoints) {
  for (const char* name : {"a.xyz", "a.csv", "a.ply", "a.obj", "a.off", "a.las", "a.pcd", "a.json",
                           "a.node", "a.vtu", "a", "a.unknown"}) {
    EXPECT_NE(complaint_about_points(name, "").find("empty"), std::string::npos);
    complaint_about_points(name, " \n\n");
    complaint_about_points(name, "# nothing\n");
    complaint_about_points(name, std::string(1000, '\0'));
    complaint_about_points(name, "garbage\n\xff\xfe\x01garbage");
  }
  for (const char* content :
       {"ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nend_header\n",
        "OFF\n0 0 0\n", "# c\nvn 1 2 3\n", "[]"}) {
    EXPECT_NE(complaint_about_points("a", content).find("no points"), std::string::npos) << content;
  }
  EXPECT_NE(complaint_about_points("a.node", "0 2 0 0\n").find("no points"), std::string::npos);
  EXPECT_NE(complaint_about_points("a.csv", "x,y\n").find("no points"), std::string::npos);
  EXPECT_THROW(read_points("/nonexistent/a.xyz"), FileError);
}

TEST(ReadPoints, ComparesCountsWithTheFileBeforeItAllocates) {
  for (const char* count : {"4", "4294967296", "1152921504606846976", "9223372036854775807",
                            "18446744073709551616", "-1", "1e9"}) {
    const std::string n = count;
    const std::string properties = "\nproperty float x\nproperty float y\nproperty float z\n";
    for (const char* encoding : {"ascii", "binary_little_endian", "binary_big_endian"}) {
      const std::string header = std::string("ply\nformat ") + encoding + " 1.0\n";
      complaint_about_points(
          "a.ply", header + "element vertex " + n + properties + "end_header\n1 2 3\n4 5 6\n");
      complaint_about_points("a.ply", header + "element face " + n +
                                          "\nproperty list uchar int a\n" + "element vertex 1" +
                                          properties + "end_header\n1 2 3\n");
    }
    complaint_about_points("a.off", "OFF\n" + n + " 0 0\n1 2 3\n4 5 6\n");
    complaint_about_points("a.node", n + " 2 0 0\n1 2 3\n2 5 6\n");
  }
}

TEST(ReadPoints, ReadsObj) {
  const PointCloud cloud = points_in(
      "a.obj", "# c\nmtllib a.mtl\nv 1 2 3\nvt 9 9\n v\t4 5 6 1.0\nvn 0 0 1\nf 1/2/3 2 1\n");
  EXPECT_EQ(cloud.positions, (Positions{{1, 2, 3}, {4, 5, 6}}));
  const PointCloud coloured = points_in("a.obj", "v 1 2 3 1 0.5 0\nv 4 5 6 0 0 2\n");
  EXPECT_EQ(coloured.colours[0], glm::u8vec4(255, 128, 0, 255));
  EXPECT_EQ(coloured.colours[1], glm::u8vec4(0, 0, 255, 255));
  EXPECT_NE(complaint_about_points("a.obj", "v 1 2 3\nv 1 2\n").find("line 2"), std::string::npos);
  complaint_about_points("a.obj", "v 1 2 nan\n");
}

TEST(ReadPoints, ReadsOff) {
  const Positions expected = {{1, 2, 3}, {4, 5, 6}};
  for (const char* text :
       {"OFF\n2 0 0\n1 2 3\n4 5 6\n", "# c\nOFF 2 1 0 # c\n\n1 2 3\n# c\n4 5 6\n3 0 1 0\n",
        "NOFF\n2 0\n1 2 3 0 0 1\n4 5 6 0 0 1", "COFF\n2\n0 0\n1 2 3 255 0 1 9\n4 5 6 3 4 5 9\n"}) {
    EXPECT_EQ(points_in("a.off", text).positions, expected) << text;
  }
  EXPECT_EQ(points_in("a.off", "COFF\n1 0 0\n1 2 3 0.5 1 0 1\n").colours[0],
            glm::u8vec4(128, 255, 0, 255));
  complaint_about_points("a.off", "OFF BINARY\n2 0 0\n");
  complaint_about_points("a.off", "4OFF\n1 0 0\n1 2 3 4\n");
  complaint_about_points("a.off", "OFF\n2 0 0\n1 2 3\n");
  complaint_about_points("a.off", "OFF\n2\n");
}

TEST(ReadPoints, ReadsJson) {
  EXPECT_EQ(points_in("a.json", " [[1, 2.5],\n[-3e2, 4]]\n").positions,
            (Positions{{1, 2.5, 0}, {-300, 4, 0}}));
  EXPECT_TRUE(points_in("a.json", "[[1,2,3]]").has_z);
  EXPECT_EQ(points_in("a.json", "[[0.1, 1e-400, 18446744073709551615]]").positions[0],
            glm::dvec3(0.1, 0, 18446744073709551615.0));
  for (const char* text : {"[[1,2],[3]]", "[[1,2],[1,2,3]]", "[[1,2,3,4]]", "[1,2]", "[[1,[2]]]",
                           "[[1,null]]", "[[1,\"2\"]]", "[{\"x\":1}]", "[[1,2]", "[[1,1e999]]",
                           "[[1,2]]x", "[[1,NaN]]", "[[]]", "[[1,true]]", "5", "[[1,2],]"}) {
    complaint_about_points("a.json", text);
  }
  EXPECT_NE(complaint_about_points("a.json", "[[1,2],[3]]").find("point 1"), std::string::npos);
  EXPECT_NE(complaint_about_points("a.json", "[[1,2],x]").find("byte 8"), std::string::npos);
  complaint_about_points("a.json", std::string(1000000, '['));
}

TEST(ReadPoints, ReadsNode) {
  const std::string rows = "# c\n3 2 1 1\n1 10 20 7 0\n2 11 21 8 1\n3 12 22 9 0\n";
  EXPECT_EQ(points_in("a.node", rows).positions,
            (Positions{{10, 20, 7}, {11, 21, 8}, {12, 22, 9}}));
  const PointCloud flat = points_in("a.node", "2 2\n0 1 2\n1 3 4 # c\n");
  EXPECT_EQ(flat.positions, (Positions{{1, 2, 0}, {3, 4, 0}}));
  EXPECT_FALSE(flat.has_z);
  EXPECT_TRUE(points_in("a.node", "1 3 0 0\n0 1 2 3\n").has_z);
  complaint_about_points("a.node", "2 2 0 0\n5 1 2\n6 3 4\n");
  complaint_about_points("a.node", "2 2 0 0\n0 1 2\n2 3 4\n");
  complaint_about_points("a.node", "2 4 0 0\n0 1 2 3 4\n1 3 4 5 6\n");
  complaint_about_points("a.node", "2 2 0 0\n0 1 2\n1 3 inf\n");
}

TEST(ReadPoints, TellsWhatItLeavesOut) {
  const auto warnings = [](const std::string& name, const std::string& content) {
    return points_in(name, content).warnings;
  };
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
  EXPECT_EQ(warnings("a.txt", "3 2\n0 0\n1.5 0\n1 1\n0 1\n1 2\n").size(), 1U);
  EXPECT_EQ(warnings("a.obj", vertices + "l 1 2\n").size(), 1U);
  EXPECT_TRUE(warnings("a.txt", "3 0\n0 0\n1.5 0\n1 1\n").empty());
  EXPECT_TRUE(warnings("a.obj", vertices).empty());
  EXPECT_TRUE(warnings("a.csv", "x,y,z\n1,2,3\n").empty());
  EXPECT_EQ(warnings("a.csv", "id,x,\"gps time\",y,height,z\n1,2,3,4,5,6\n"),
            (std::vector<std::string>{"columns left out: id, \"gps time\", height"}));
  EXPECT_EQ(warnings("a.csv", "a,b,c,d\n1,2,3,4\n"),
            (std::vector<std::string>{"line 1 names no column that is known (a, b, c, d): took the "
                                      "first columns for x, y and z"}));
}

// Cut at every byte, a file is an error or fewer points, never more and never a crash.
TEST(ReadPoints, SurvivesFilesCutAtEveryByte) {
  const std::vector<std::pair<std::string, std::string>> files = {
      {"a.ply", ply_of_points("ascii", true)},
      {"a.ply", ply_of_points("binary_little_endian", false)},
      {"a.ply", ply_of_points("binary_big_endian", true)},
      {"a.las", las_of_points(2, 3, 34, 28)},
      {"a.las", las_of_points(4, 7, 36, 30)},
      {"a.off", "OFF\n2 1 0\n1 2 3\n4 5 6\n3 0 1 0\n"},
      {"a.obj", "v 1 2 3\nv 4 5 6\nf 1 2 1\n"},
      {"a.node", "2 2 1 1\n1 10 20 7 0\n2 11 21 8 1\n"},
      {"a.json", "[[1.5, 2], [3e5, 4]]"},
      {"a.pcd",
       "# .PCD v0.7\nFIELDS x y\nSIZE 4 4\nTYPE F F\nCOUNT 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA "
       "ascii\n1 2\n3 4\n"},
      {"a.csv", "x,y,red,green,blue,intensity\n1,2,3,4,5,6\n2,3,4,5,6,7\n"},
  };
  const tests::TemporaryFolder folder;
  for (const auto& [name, content] : files) {
    const std::size_t whole = points_in(name, content).size();
    for (std::size_t cut = 0; cut < content.size(); ++cut) {
      try {
        EXPECT_LE(read_points(folder.write(name, content.substr(0, cut))).size(), whole);
      } catch (const FileError& error) {
        EXPECT_EQ(error.cause(), Cause::input);
      }
    }
  }
}

TEST(ReadPoints, SurvivesRandomDamage) {
  const std::vector<std::pair<std::string, std::string>> files = {
      {"a.ply", ply_of_points("ascii", true)},
      {"a.ply", ply_of_points("binary_little_endian", false)},
      {"a.ply", ply_of_points("binary_big_endian", true)},
      {"a.las", las_of_points(4, 7, 36, 30)},
      {"a.off", "OFF\n2 1 0\n1 2 3\n4 5 6\n3 0 1 0\n"},
      {"a.node", "2 2 1 1\n1 10 20 7 0\n2 11 21 8 1\n"},
      {"a.json", "[[1.5, 2], [3e5, 4]]"},
      {"a.pcd",
       "# .PCD v0.7\nFIELDS x y\nSIZE 4 4\nTYPE F F\nCOUNT 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA "
       "ascii\n1 2\n3 4\n"},
      {"a.csv", "x,y,red\n1,2,3\n2,3,4\n"},
  };
  const tests::TemporaryFolder folder;
  const unsigned seed = 20041;
  std::mt19937 random(seed);
  SCOPED_TRACE(seed);
  for (int round = 0; round < 400; ++round) {
    auto [name, content] = files[random() % files.size()];
    for (int k = 0; k < 3; ++k) content[random() % content.size()] = static_cast<char>(random());
    try {
      const PointCloud cloud = read_points(folder.write(name, content));
      EXPECT_LE(cloud.size(), content.size());
      for (const glm::dvec3& p : cloud.positions) {
        EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
      }
    } catch (const FileError& error) {
      EXPECT_EQ(error.cause(), Cause::input);
    }
  }
}

TEST(ReadPoints, FormatMayBeGiven) {
  const tests::TemporaryFolder folder;
  const auto path = folder.write("a.xyz", "2 2 0 0\n0 5 6\n1 7 8\n");
  EXPECT_EQ(read_points(path, {files::Format::node}).positions, (Positions{{5, 6, 0}, {7, 8, 0}}));
  EXPECT_THROW(read_points(path, {files::Format::glb}), FileError);
}

TEST(ReadPoints, TableNamesEveryReaderOnce) {
  std::string names;
  for (const PointReader& reader : point_readers()) {
    EXPECT_EQ(names.find(reader.name), std::string::npos);
    names += std::string(reader.name) + " ";
    EXPECT_FALSE(reader.description.empty());
    EXPECT_TRUE(reader.suffixes.starts_with('.'));
  }
}

TEST(ReadPoints, ReadsRealFiles) {
  const std::filesystem::path folder = DELRAY_SHARED_DATA;
  if (!exists(folder)) GTEST_SKIP() << "no real data in " << folder;
  const PointCloud lidar = read_points(folder / "CSite1-lidar.ply");
  EXPECT_EQ(lidar.size(), 522674U);
  EXPECT_EQ(lidar.positions.back(), glm::dvec3(513149.96875, 5404078.5, double{343.1F}));
  const PointCloud autzen = read_points(folder / "autzen_trim.las");
  EXPECT_EQ(autzen.size(), 110000U);
  EXPECT_EQ(autzen.colours.size(), 110000U);
  for (const glm::dvec3& p : autzen.positions) {  // bounds that the header states
    ASSERT_TRUE(p.x >= 636001.76 && p.x <= 638994.75) << p.x;
    ASSERT_TRUE(p.y >= 848935.2 && p.y <= 853535.43) << p.y;
    ASSERT_TRUE(p.z >= 406.26 && p.z <= 615.26) << p.z;
  }
  const PointCloud lake = read_points(folder / "LakeSuperior.txt");
  EXPECT_EQ(lake.size(), 1552U);
  EXPECT_EQ(lake.positions.front(), glm::dvec3(316.43027, 404.47559, 0));
  EXPECT_EQ(read_points(folder / "stanford-bunny.obj").size(), 35947U);
  EXPECT_EQ(read_points(folder / "ukraine.json").size(), 874U);
}

}  // namespace
}  // namespace delray::delaunay
