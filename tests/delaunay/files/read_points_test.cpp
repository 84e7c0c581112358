// Point readers: every format, and the place that messages about bad files name.
#include "delaunay/read_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <random>
#include <string>

#include "files/error.h"
#include "tests/support/temporary_folder.h"

namespace delray::delaunay {
namespace {

using files::Cause;
using files::FileError;
using Positions = std::vector<glm::dvec3>;

PointCloud read(const std::string& name, const std::string& content) {
  const tests::TemporaryFolder folder;
  return read_points(folder.write(name, content));
}

// Reads a broken file; the message must name the file.
std::string complaint(const std::string& name, const std::string& content) {
  try {
    read(name, content);
  } catch (const FileError& error) {
    EXPECT_EQ(error.cause(), Cause::input);
    EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error from " << name << ": " << content.substr(0, 200);
  return "";
}

template <class T>
void append(std::string& bytes, T value, bool big_endian = false) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (big_endian) std::ranges::reverse(raw);
  bytes.append(raw.data(), raw.size());
}

TEST(ReadPoints, TakesAnySeparatorAndComments) {
  const Positions expected = {{1, 2, 3}, {-4.5, 5e-3, 6}};
  for (const char* text :
       {"1 2 3\n-4.5 5e-3 6\n", "1,2,3\r\n-4.5,5e-3,6\r\n", "1;2;3\n-4.5;5e-3;6",
        "1\t2\t3\n-4.5\t5e-3\t6\n", "# c\n\n  1 ,\t2, 3  # c\n// c\n-4.5,5e-3,+6\n\n",
        "\xef\xbb\xbf"
        "1 2 3\n-4.5 5e-3 6\n"}) {
    const PointCloud cloud = read("a.xyz", text);
    EXPECT_EQ(cloud.positions, expected) << text;
    EXPECT_TRUE(cloud.has_z);
  }
  EXPECT_NE(complaint("a.xyz", "1 2\n+-3 4\n").find("line 2"), std::string::npos);
}

TEST(ReadPoints, KeepsDoublesAsWritten) {
  const PointCloud cloud =
      read("a.txt", "0.1 1e-320\n1e-400 123456789012345678901234567890\n-0 +7\n");
  EXPECT_FALSE(cloud.has_z);
  EXPECT_EQ(cloud.positions[0], glm::dvec3(0.1, 1e-320, 0));
  EXPECT_EQ(cloud.positions[1], glm::dvec3(0, 123456789012345678901234567890.0, 0));
  EXPECT_EQ(cloud.positions[2], glm::dvec3(0, 7, 0));
}

TEST(ReadPoints, FindsColumnsByName) {
  const PointCloud cloud = read("a.csv",
                                "id,\"Y\",X,point name,Intensity,red,green,blue,classification,Z\n"
                                "1,20,10,a,50,1,2,3,6,30\n2,21,11,b,100,255,0,4,2,31\n");
  EXPECT_EQ(cloud.positions, (Positions{{10, 20, 30}, {11, 21, 31}}));
  EXPECT_EQ(cloud.colours[1], glm::u8vec4(255, 0, 4, 255));
  EXPECT_EQ(cloud.intensity, (std::vector<float>{0.5F, 1.0F}));
  EXPECT_EQ(cloud.classification, (std::vector<std::uint8_t>{6, 2}));
  EXPECT_EQ(read("a.csv", "lon;lat\n1;2\n").positions, (Positions{{1, 2, 0}}));
  EXPECT_EQ(read("a.csv", "some title\n1 2 3\n").positions, (Positions{{1, 2, 3}}));
  EXPECT_NE(complaint("a.csv", "x,z\n1,2\n").find("no y"), std::string::npos);
}

TEST(ReadPoints, KnowsTheNamesThatSurveyorsAndExportersUse) {
  for (const char* names :
       {"id,lon,lat,ele", "id,lng,lat,elev", "id,long,lat,alt", "id,E,N,H", "id,East,North,dem",
        "id,X_COORD,Y_COORD,Z_COORD", "id,POINT_X,POINT_Y,POINT_Z", "id,x,y,value",
        "id,easting,northing,elevation", "e,x,y,z"}) {
    EXPECT_EQ(read("a.csv", std::string(names) + "\n7,1,2,3\n").positions, (Positions{{1, 2, 3}}))
        << names;
  }
}

TEST(ReadPoints, RefusesRowsThatWouldLoseTheirHeights) {
  EXPECT_NE(complaint("a.xyz", "0 0\n1 0\n0 1 5\n1 1 2\n").find("line 3"), std::string::npos);
  EXPECT_NE(complaint("a.csv", "0,0\n1,0,\n0,1,5\n").find("line 3"), std::string::npos);
  EXPECT_EQ(read("a.xyz", "0 0 # c\n1 0 # 5\n").size(), 2U);
}

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
      EXPECT_EQ(read(name, converted(text)).positions, (Positions{{1, 2, 3}, {4, 5, 6}}))
          << name << (end[1] == 0 ? " with CR" : " with CR LF");
    }
    std::string bytes = converted(binary);
    // A body with bytes that look like line ends.
    for (const float x : {std::bit_cast<float>(0x3f0d0d0dU), 2.0F, 3.0F, 4.0F, 5.0F, 6.0F}) {
      append(bytes, x);
    }
    if (end[1] == 0) {
      const PointCloud cloud = read("a.ply", bytes);
      EXPECT_EQ(cloud.positions[0].x, double{std::bit_cast<float>(0x3f0d0d0dU)});
      EXPECT_EQ(cloud.positions[1], glm::dvec3(4, 5, 6));
    }
  }
}

TEST(ReadPoints, TakesSixColumnsAsColoursIfTheyAreBytes) {
  EXPECT_EQ(read("a.xyz", "1 2 3 255 0 7\n4 5 6 1 2 3\n").colours.size(), 2U);
  EXPECT_TRUE(read("a.xyz", "1 2 3 0 0 1\n4 5 6 0.6 0.8 0\n").colours.empty());
  EXPECT_TRUE(read("a.xyz", "1 2 3 0 0 1\n4 5 6 0 0 -1\n").colours.empty());
}

TEST(ReadPoints, SkipsALineOfCounts) {
  EXPECT_EQ(read("a.txt", "2\n1 2 3\n4 5 6\n").positions, (Positions{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(read("a.txt", "3 2\n1 2\n4 5\n7 9\n0 1\n1 2\n").size(), 3U);
  EXPECT_EQ(read("a.txt", "2 0\n  1.5 2.5\n  4.5 5.5").size(), 2U);
  // The same first lines can be points.
  EXPECT_EQ(read("a.txt", "2 0\n1 2\n4 5\n").size(), 3U);
  EXPECT_EQ(read("a.txt", "3 2\n1 2\n4 5\n7 9\n0 1.5\n1 2\n").size(), 6U);
  EXPECT_EQ(read("a.txt", "3 2\n1.5 2\n4 5\n").size(), 3U);
  EXPECT_NE(complaint("a.txt", "3\n1 2\n4 5\n").find("line 1"), std::string::npos);
  complaint("a.txt", "99999999999999999999\n1 2\n");
  complaint("a.txt", "9999999999999999\n1 2\n");
}

TEST(ReadPoints, NamesTheLineOfBadText) {
  EXPECT_NE(complaint("a.xyz", "1 2 3\n\n4 x 6\n").find("line 3"), std::string::npos);
  EXPECT_NE(complaint("a.xyz", "1 2 3\n4 5\n").find("line 2"), std::string::npos);
  EXPECT_NE(complaint("a.xyz", "1 2 3\n4 nan 6\n").find("line 2"), std::string::npos);
  EXPECT_NE(complaint("a.xyz", "1 -inf 3\n").find("line 1"), std::string::npos);
  EXPECT_NE(complaint("a.xyz", "1 1e999 3\n").find("line 1"), std::string::npos);
  EXPECT_NE(complaint("a.csv", "1,,3\n").find("line 1"), std::string::npos);
  EXPECT_NE(complaint("a.csv", "1,5;2,5\n").find("line 1"), std::string::npos);
  EXPECT_NE(complaint("a.xyz", "1 0x10 3\n").find("line 1"), std::string::npos);
  EXPECT_NE(complaint("a.xyz", "1\n").find("line 1"), std::string::npos);
  std::string many;
  for (int i = 0; i < 100000; ++i) many += i == 40000 || i == 90000 ? "bad\n" : "1 2 3\n";
  EXPECT_NE(complaint("a.xyz", many).find("line 40001"), std::string::npos);
}

TEST(ReadPoints, RefusesFilesWithoutPoints) {
  for (const char* name : {"a.xyz", "a.csv", "a.ply", "a.obj", "a.off", "a.las", "a.json", "a.node",
                           "a.vtu", "a", "a.unknown"}) {
    EXPECT_NE(complaint(name, "").find("empty"), std::string::npos);
    complaint(name, " \n\n");
    complaint(name, "# nothing\n");
    complaint(name, std::string(1000, '\0'));
    complaint(name, "garbage\n\xff\xfe\x01garbage");
  }
  for (const char* content :
       {"ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nend_header\n",
        "OFF\n0 0 0\n", "# c\nvn 1 2 3\n", "[]"}) {
    EXPECT_NE(complaint("a", content).find("no points"), std::string::npos) << content;
  }
  EXPECT_NE(complaint("a.node", "0 2 0 0\n").find("no points"), std::string::npos);
  EXPECT_NE(complaint("a.csv", "x,y\n").find("no points"), std::string::npos);
  EXPECT_THROW(read_points("/nonexistent/a.xyz"), FileError);
}

// A PLY with properties of all kinds, a list before the coordinates and an element before the
// vertices.
std::string ply(const char* encoding, bool lists) {
  std::string text = std::string("ply\nformat ") + encoding +
                     " 1.0\ncomment c\nelement camera 2\nproperty list uchar short a\n"
                     "property char b\nelement vertex 3\nproperty uchar blue\n";
  if (lists) text += "property list ushort int skipped\n";
  text +=
      "property float z\nproperty double x\nproperty int16 y\nproperty uchar red\n"
      "property uchar green\nproperty ushort intensity\nelement face 1\n"
      "property list uchar uint vertex_indices\nend_header\n";
  if (std::strcmp(encoding, "ascii") == 0) {
    text += "2 -1 -2 5\n0 7\n";
    for (int i = 0; i < 3; ++i) {
      const std::string n = std::to_string(i);
      text += n + (lists ? (i == 1 ? " 2 100000 -5 " : " 0 ") : " ") + "0.5 0.1 -" + n +
              " 254 7 65535\n";
    }
    return text + "3 0 1 2\n";
  }
  const bool big = std::strcmp(encoding, "binary_big_endian") == 0;
  append(text, std::uint8_t{2});
  append(text, std::int16_t{-1}, big);
  append(text, std::int16_t{-2}, big);
  append(text, std::int8_t{5});
  append(text, std::uint8_t{0});
  append(text, std::int8_t{7});
  for (int i = 0; i < 3; ++i) {
    append(text, static_cast<std::uint8_t>(i));
    if (lists) {
      append(text, static_cast<std::uint16_t>(i == 1 ? 2 : 0), big);
      for (int k = 0; i == 1 && k < 2; ++k) append(text, std::int32_t{100000}, big);
    }
    append(text, 0.5F, big);
    append(text, 0.1, big);
    append(text, static_cast<std::int16_t>(-i), big);
    append(text, std::uint8_t{254});
    append(text, std::uint8_t{7});
    append(text, std::uint16_t{65535}, big);
  }
  append(text, std::uint8_t{3});
  for (std::uint32_t i = 0; i < 3; ++i) append(text, i, big);
  return text;
}

TEST(ReadPoints, ReadsPlyOfEveryEncoding) {
  for (const char* encoding : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    for (const bool lists : {false, true}) {
      SCOPED_TRACE(std::string(encoding) + (lists ? " with lists" : ""));
      const PointCloud cloud = read("a.ply", ply(encoding, lists));
      EXPECT_TRUE(cloud.has_z);
      EXPECT_EQ(cloud.positions, (Positions{{0.1, 0, 0.5}, {0.1, -1, 0.5}, {0.1, -2, 0.5}}));
      EXPECT_EQ(cloud.colours[2], glm::u8vec4(254, 7, 2, 255));
      EXPECT_EQ(cloud.intensity, (std::vector<float>{1, 1, 1}));
    }
  }
}

TEST(ReadPoints, ReadsPlyWhoseBodyBeginsLikeALineAndWhoseFirstLineEndsWithABlank) {
  for (const char* line_end : {"\n", "\r\n", " \n", "\t\r\n"}) {
    std::string text;
    for (const char* line : {"ply", "format binary_big_endian 1.0", "element vertex 2",
                             "property short x", "property short y", "end_header"}) {
      text += line + (text.empty()                  ? std::string(line_end)
                      : std::strchr(line_end, '\r') ? "\r\n"
                                                    : "\n");
    }
    for (const std::int16_t x : {0x0A0D, 0x0D0A, 0x0A0A, 1}) append(text, x, true);
    EXPECT_EQ(read("a.ply", text).positions, (Positions{{0x0A0D, 0x0D0A, 0}, {0x0A0A, 1, 0}}));
  }
}

TEST(ReadPoints, WidensFloatsOfPlyExactly) {
  std::string text =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\n"
      "property float y\nend_header\n";
  append(text, 0.1F);
  append(text, std::numeric_limits<float>::denorm_min());
  const PointCloud cloud = read("a.ply", text);
  EXPECT_FALSE(cloud.has_z);
  EXPECT_EQ(cloud.positions[0],
            glm::dvec3(double{0.1F}, double{std::numeric_limits<float>::denorm_min()}, 0));
}

TEST(ReadPoints, NamesTheVertexOfBadPly) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    std::string text =
        "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty float x\n"
        "property float y\nend_header\n";
    for (int i = 0; i < 6; ++i) append(text, i == 3 ? bad : 1.0F, true);
    EXPECT_NE(complaint("a.ply", text).find("vertex 1"), std::string::npos);
  }
  const std::string header = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n";
  EXPECT_NE(complaint("a.ply", header + "property float y\nend_header\n1 nan\n").find("line 7"),
            std::string::npos);
  complaint("a.ply", header + "end_header\n1\n");
  complaint("a.ply", header + "property strange y\nend_header\n1 1\n");
  complaint("a.ply", header + "property list float int y\nend_header\n1 1\n");
  complaint("a.ply",
            "ply\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n1 1\n");
}

TEST(ReadPoints, ComparesCountsWithTheFileBeforeItAllocates) {
  for (const char* count : {"4", "4294967296", "1152921504606846976", "9223372036854775807",
                            "18446744073709551616", "-1", "1e9"}) {
    const std::string n = count;
    const std::string properties = "\nproperty float x\nproperty float y\nproperty float z\n";
    for (const char* encoding : {"ascii", "binary_little_endian", "binary_big_endian"}) {
      const std::string header = std::string("ply\nformat ") + encoding + " 1.0\n";
      complaint("a.ply",
                header + "element vertex " + n + properties + "end_header\n1 2 3\n4 5 6\n");
      complaint("a.ply", header + "element face " + n + "\nproperty list uchar int a\n" +
                             "element vertex 1" + properties + "end_header\n1 2 3\n");
    }
    complaint("a.off", "OFF\n" + n + " 0 0\n1 2 3\n4 5 6\n");
    complaint("a.node", n + " 2 0 0\n1 2 3\n2 5 6\n");
  }
}

TEST(ReadPoints, ReadsObj) {
  const PointCloud cloud =
      read("a.obj", "# c\nmtllib a.mtl\nv 1 2 3\nvt 9 9\n v\t4 5 6 1.0\nvn 0 0 1\nf 1/2/3 2 1\n");
  EXPECT_EQ(cloud.positions, (Positions{{1, 2, 3}, {4, 5, 6}}));
  const PointCloud coloured = read("a.obj", "v 1 2 3 1 0.5 0\nv 4 5 6 0 0 2\n");
  EXPECT_EQ(coloured.colours[0], glm::u8vec4(255, 128, 0, 255));
  EXPECT_EQ(coloured.colours[1], glm::u8vec4(0, 0, 255, 255));
  EXPECT_NE(complaint("a.obj", "v 1 2 3\nv 1 2\n").find("line 2"), std::string::npos);
  complaint("a.obj", "v 1 2 nan\n");
}

TEST(ReadPoints, ReadsOff) {
  const Positions expected = {{1, 2, 3}, {4, 5, 6}};
  for (const char* text :
       {"OFF\n2 0 0\n1 2 3\n4 5 6\n", "# c\nOFF 2 1 0 # c\n\n1 2 3\n# c\n4 5 6\n3 0 1 0\n",
        "NOFF\n2 0\n1 2 3 0 0 1\n4 5 6 0 0 1", "COFF\n2\n0 0\n1 2 3 255 0 1 9\n4 5 6 3 4 5 9\n"}) {
    EXPECT_EQ(read("a.off", text).positions, expected) << text;
  }
  EXPECT_EQ(read("a.off", "COFF\n1 0 0\n1 2 3 0.5 1 0 1\n").colours[0],
            glm::u8vec4(128, 255, 0, 255));
  complaint("a.off", "OFF BINARY\n2 0 0\n");
  complaint("a.off", "4OFF\n1 0 0\n1 2 3 4\n");
  complaint("a.off", "OFF\n2 0 0\n1 2 3\n");
  complaint("a.off", "OFF\n2\n");
}

TEST(ReadPoints, ReadsJson) {
  EXPECT_EQ(read("a.json", " [[1, 2.5],\n[-3e2, 4]]\n").positions,
            (Positions{{1, 2.5, 0}, {-300, 4, 0}}));
  EXPECT_TRUE(read("a.json", "[[1,2,3]]").has_z);
  EXPECT_EQ(read("a.json", "[[0.1, 1e-400, 18446744073709551615]]").positions[0],
            glm::dvec3(0.1, 0, 18446744073709551615.0));
  for (const char* text : {"[[1,2],[3]]", "[[1,2],[1,2,3]]", "[[1,2,3,4]]", "[1,2]", "[[1,[2]]]",
                           "[[1,null]]", "[[1,\"2\"]]", "[{\"x\":1}]", "[[1,2]", "[[1,1e999]]",
                           "[[1,2]]x", "[[1,NaN]]", "[[]]", "[[1,true]]", "5", "[[1,2],]"}) {
    complaint("a.json", text);
  }
  EXPECT_NE(complaint("a.json", "[[1,2],[3]]").find("point 1"), std::string::npos);
  EXPECT_NE(complaint("a.json", "[[1,2],x]").find("byte 8"), std::string::npos);
  complaint("a.json", std::string(1000000, '['));
}

TEST(ReadPoints, ReadsNode) {
  const std::string rows = "# c\n3 2 1 1\n1 10 20 7 0\n2 11 21 8 1\n3 12 22 9 0\n";
  EXPECT_EQ(read("a.node", rows).positions, (Positions{{10, 20, 7}, {11, 21, 8}, {12, 22, 9}}));
  const PointCloud flat = read("a.node", "2 2\n0 1 2\n1 3 4 # c\n");
  EXPECT_EQ(flat.positions, (Positions{{1, 2, 0}, {3, 4, 0}}));
  EXPECT_FALSE(flat.has_z);
  EXPECT_TRUE(read("a.node", "1 3 0 0\n0 1 2 3\n").has_z);
  complaint("a.node", "2 2 0 0\n5 1 2\n6 3 4\n");
  complaint("a.node", "2 2 0 0\n0 1 2\n2 3 4\n");
  complaint("a.node", "2 4 0 0\n0 1 2 3 4\n1 3 4 5 6\n");
  complaint("a.node", "2 2 0 0\n0 1 2\n1 3 inf\n");
}

// A LAS file of two points.
std::string las(int minor, unsigned format, std::size_t record, std::size_t colour) {
  std::string bytes(minor == 4 ? 375 : 227, '\0');
  const auto put = [&](std::size_t at, auto value) {
    std::memcpy(&bytes[at], &value, sizeof value);
  };
  bytes.replace(0, 4, "LASF");
  put(24, std::uint8_t{1});
  put(25, static_cast<std::uint8_t>(minor));
  put(94, static_cast<std::uint16_t>(bytes.size()));
  put(96, static_cast<std::uint32_t>(bytes.size()));
  put(104, static_cast<std::uint8_t>(format));
  put(105, static_cast<std::uint16_t>(record));
  if (minor == 4) {
    put(247, std::uint64_t{2});
  } else {
    put(107, std::uint32_t{2});
  }
  for (int k = 0; k < 3; ++k) {
    put(131 + 8 * k, 0.25);
    put(155 + 8 * k, 1000.0 * k);
  }
  for (int i = 0; i < 2; ++i) {
    std::string row(record, '\x7e');
    const auto put_row = [&](std::size_t at, auto value) {
      std::memcpy(&row[at], &value, sizeof value);
    };
    for (int k = 0; k < 3; ++k) put_row(4 * k, std::int32_t{-8 + 4 * i + k});
    put_row(12, static_cast<std::uint16_t>(65535 * i));
    put_row(format < 6 ? 15 : 16, static_cast<std::uint8_t>(format < 6 ? 0xe0 | 6 : 66));
    for (int k = 0; colour > 0 && k < 3; ++k) {
      put_row(colour + 2 * k, static_cast<std::uint16_t>(257 * (k + 1) * (i == 1 ? 80 : 1)));
    }
    bytes += row;
  }
  return bytes;
}

TEST(ReadPoints, ReadsLasOfEveryVersionAndPointFormat) {
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
      const PointCloud cloud = read("a.las", las(minor, format, record + minor, colour));
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
  std::string bytes = las(2, 3, 34, 28);
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

TEST(ReadPoints, KnowsDegrees) {
  const auto keys = [](std::uint16_t model) {
    std::string directory;
    for (const int value : {1, 1, 0, 1, 1024, 0, 1, int{model}})
      append(directory, static_cast<std::uint16_t>(value));
    return directory;
  };
  EXPECT_TRUE(read("a.las", las_with_projection(34735, keys(2))).geographic);
  EXPECT_FALSE(read("a.las", las_with_projection(34735, keys(1))).geographic);
  EXPECT_TRUE(read("a.las", las_with_projection(2112, "GEOGCS[\"WGS 84\"]")).geographic);
  EXPECT_FALSE(
      read("a.las", las_with_projection(2112, "PROJCS[\"x\",GEOGCS[\"WGS 84\"]]")).geographic);
  EXPECT_FALSE(read("a.las", las_with_projection(34735, "")).geographic);
  // Without a word steps tell, but not where a projection is told.
  const auto in_fine_steps = [](std::string bytes) {
    for (int k = 0; k < 3; ++k) {
      const double step = k == 2 ? 0.01 : 1e-7, offset = 10.0 + k;
      std::memcpy(&bytes[131 + 8 * k], &step, sizeof step);
      std::memcpy(&bytes[155 + 8 * k], &offset, sizeof offset);
    }
    return bytes;
  };
  EXPECT_TRUE(read("a.las", in_fine_steps(las(2, 3, 34, 28))).geographic);
  EXPECT_FALSE(read("a.las", in_fine_steps(las_with_projection(34735, keys(1)))).geographic);
  EXPECT_FALSE(read("a.las", las(2, 3, 34, 28)).geographic);
  EXPECT_TRUE(read("a.csv", "Longitude,Latitude,height\n1,2,3\n").geographic);
  EXPECT_FALSE(read("a.csv", "lon,y,height\n1,2,3\n").geographic);
  EXPECT_FALSE(read("a.csv", "1,2,3\n").geographic);
}

TEST(ReadPoints, TellsWhatItLeavesOut) {
  const auto warnings = [](const std::string& name, const std::string& content) {
    return read(name, content).warnings;
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

TEST(ReadPoints, RefusesBrokenLas) {
  const std::string good = las(2, 3, 34, 28);
  const auto with = [&](std::size_t at, auto value) {
    std::string bytes = good;
    std::memcpy(&bytes[at], &value, sizeof value);
    return bytes;
  };
  EXPECT_NE(complaint("a.las", with(104, std::uint8_t{3 | 128})).find("LAZ"), std::string::npos);
  EXPECT_NE(complaint("a.laz", with(104, std::uint8_t{3 | 64})).find("LAZ"), std::string::npos);
  complaint("a.las", with(104, std::uint8_t{11}));
  complaint("a.las", with(105, std::uint16_t{33}));
  complaint("a.las", with(107, std::uint32_t{3}));
  complaint("a.las", with(107, std::uint32_t{0xffffffff}));
  complaint("a.las", with(96, std::uint32_t{0xffffffff}));
  for (const std::uint32_t begin : {0U, 4U, 226U}) {
    EXPECT_NE(complaint("a.las", with(96, begin)).find("byte 96: points cannot begin inside"),
              std::string::npos);
  }
  EXPECT_NE(complaint("a.las", with(94, std::uint16_t{0})).find("byte 94"), std::string::npos);
  complaint("a.las", with(24, std::uint8_t{2}));
  complaint("a.las", with(25, std::uint8_t{5}));
  complaint("a.las", with(131, std::numeric_limits<double>::quiet_NaN()));
  complaint("a.las", with(155, std::numeric_limits<double>::infinity()));
  complaint("a.las", with(131, 1e308));
  EXPECT_NE(complaint("a.las", with(107, std::uint32_t{0})).find("no points"), std::string::npos);
  std::string las14 = las(4, 6, 30, 0);
  const std::uint64_t huge = std::uint64_t{1} << 60;
  std::memcpy(&las14[247], &huge, sizeof huge);
  complaint("a.las", las14);
}

// Cut at every byte, a file is an error or fewer points, never more and never a crash.
TEST(ReadPoints, SurvivesFilesCutAtEveryByte) {
  const std::vector<std::pair<std::string, std::string>> files = {
      {"a.ply", ply("ascii", true)},
      {"a.ply", ply("binary_little_endian", false)},
      {"a.ply", ply("binary_big_endian", true)},
      {"a.las", las(2, 3, 34, 28)},
      {"a.las", las(4, 7, 36, 30)},
      {"a.off", "OFF\n2 1 0\n1 2 3\n4 5 6\n3 0 1 0\n"},
      {"a.obj", "v 1 2 3\nv 4 5 6\nf 1 2 1\n"},
      {"a.node", "2 2 1 1\n1 10 20 7 0\n2 11 21 8 1\n"},
      {"a.json", "[[1.5, 2], [3e5, 4]]"},
      {"a.csv", "x,y,red,green,blue,intensity\n1,2,3,4,5,6\n2,3,4,5,6,7\n"},
  };
  const tests::TemporaryFolder folder;
  for (const auto& [name, content] : files) {
    const std::size_t whole = read(name, content).size();
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
      {"a.ply", ply("ascii", true)},
      {"a.ply", ply("binary_little_endian", false)},
      {"a.ply", ply("binary_big_endian", true)},
      {"a.las", las(4, 7, 36, 30)},
      {"a.off", "OFF\n2 1 0\n1 2 3\n4 5 6\n3 0 1 0\n"},
      {"a.node", "2 2 1 1\n1 10 20 7 0\n2 11 21 8 1\n"},
      {"a.json", "[[1.5, 2], [3e5, 4]]"},
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
