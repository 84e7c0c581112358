// Formats by content and by suffix.
#include "files/format.h"

#include <gtest/gtest.h>

#include <string>

#include "files/error.h"
#include "tests/support/temporary_folder.h"

namespace delray::files {
namespace {

using namespace std::string_literals;

FileKind kind_of(std::string_view content, std::string_view path) {
  return identify(content, content.size(), path);
}
Format format_of(std::string_view content, std::string_view path = "noname") {
  return kind_of(content, path).format;
}

TEST(Format, FollowsFromContentWhateverTheSuffix) {
  for (const char* path : {"noname", "a.xyz", "a.obj", "a.png", "a.json"}) {
    EXPECT_EQ(format_of("ply\nformat ascii 1.0\n", path), Format::ply);
    EXPECT_EQ(format_of("ply \t\r\nformat ascii 1.0\n", path), Format::ply);
    EXPECT_EQ(format_of("LASF\0\0\0\0"s, path), Format::las);
    EXPECT_EQ(format_of("OFF\n3 1 0\n", path), Format::off);
    EXPECT_EQ(format_of("# c\nCOFF 3 1 0\n", path), Format::off);
    EXPECT_EQ(format_of("# made by hand\n\nv 1 2 3\n", path), Format::obj);
    EXPECT_EQ(format_of("mtllib a.mtl\nv 1 2 3\n", path), Format::obj);
    EXPECT_EQ(format_of(" [[1, 2], [3, 4]]", path), Format::json_points);
    EXPECT_EQ(format_of("{\"asset\": {\"version\": \"2.0\"}}", path), Format::gltf);
    EXPECT_EQ(format_of("glTF\2\0\0\0"s, path), Format::glb);
    EXPECT_EQ(format_of("\x89PNG\r\n", path), Format::image);
    EXPECT_EQ(format_of("II*\0abc"s, path), Format::image);
    EXPECT_EQ(format_of("solid x\nfacet normal 0 0 1\n", path), Format::stl);
    EXPECT_EQ(format_of("<?xml version=\"1.0\"?>\n<VTKFile type=\"x\">", path), Format::vtu);
  }
}

TEST(Format, OfBinaryStlFollowsFromItsSize) {
  std::string content = "solid but binary";
  content.resize(84 + 2 * 50);
  content[80] = 2;
  content[81] = content[82] = content[83] = 0;
  EXPECT_EQ(format_of(content), Format::stl);
  content[80] = 3;
  EXPECT_NE(format_of(content), Format::stl);
}

TEST(Format, FollowsFromTheSuffixWhereContentDoesNotTell) {
  EXPECT_EQ(format_of("1 2 3\n", "a.node"), Format::node);
  EXPECT_EQ(format_of("1 2 3\n", "a.NODE"), Format::node);
  EXPECT_EQ(format_of("1 2 3\n", "a.csv"), Format::text);
  EXPECT_EQ(format_of("easting,northing\n1,2\n", "a.csv"), Format::text);
  EXPECT_EQ(format_of("", "a.ply"), Format::ply);
  EXPECT_EQ(format_of("garbage", "a.las"), Format::las);
  EXPECT_EQ(format_of("# c\n-1.5e3;2\n"), Format::text);
  EXPECT_EQ(format_of("+1,2\n", "a.dat"), Format::text);
  EXPECT_EQ(format_of("hello\n"), Format::unknown);
  EXPECT_EQ(format_of(""), Format::unknown);
}

TEST(Format, TellsPointsFromMeshes) {
  const std::string ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n";
  EXPECT_FALSE(kind_of(ply + "end_header\n", "a").has_faces);
  EXPECT_FALSE(kind_of(ply + "element face 0\nend_header\n", "a").has_faces);
  EXPECT_TRUE(kind_of(ply + "element face 1\nend_header\n", "a").has_faces);
  EXPECT_FALSE(kind_of("OFF\n3 0 0\n", "a").has_faces);
  EXPECT_TRUE(kind_of("OFF # c\n# c\n3 1 0\n", "a").has_faces);
  EXPECT_FALSE(kind_of("v 1 2 3\n", "a").has_faces);
  EXPECT_TRUE(kind_of("v 1 2 3\nf 1 1 1\n", "a").has_faces);
  EXPECT_FALSE(kind_of("1 2 3\n", "a.xyz").has_faces);
  EXPECT_FALSE(kind_of("1 2 0 0\n", "a.node").has_faces);
  EXPECT_TRUE(kind_of("1 3 0\n", "a.ele").has_faces);
}

TEST(Format, FindsTheFirstFaceFarIntoAFile) {
  const tests::TemporaryFolder folder;
  std::string points;
  while (points.size() < (std::size_t{3} << 20)) points += "v 1.25 2.5 3.75\n";
  EXPECT_FALSE(identify(folder.write("points.obj", points)).has_faces);
  EXPECT_TRUE(identify(folder.write("mesh.obj", points + "f 1 2 3\n")).has_faces);
  EXPECT_TRUE(identify(folder.write("last.obj", points + "f 1 2 3")).has_faces);
}

TEST(Format, FindsFacesBetweenLineEndsOfEveryKind) {
  for (const std::string& content :
       {"ply\rformat ascii 1.0\relement vertex 3\relement face 1\rend_header\r"s, "OFF\r3 1 0\r"s,
        "v 0 0 0\rf 1 2 3\r"s, "v 0 0 0\r\nf 1 2 3\r\n"s}) {
    EXPECT_TRUE(identify(content, content.size(), "a").has_faces) << content;
  }
}

TEST(Format, TellsThatTextIsUtf16) {
  std::string plain;
  for (const char c : "v 0 0 0\nv 1 0 0\nf 1 2 3\n"s) plain += std::string{c, '\0'};
  for (const std::string& content : {"\xff\xfe"s + plain, "\xfe\xff\0"s + plain, plain}) {
    try {
      identify(content, content.size(), "a.obj");
      ADD_FAILURE();
    } catch (const FileError& error) {
      EXPECT_NE(std::string(error.what()).find("UTF-16"), std::string::npos);
    }
  }
}

TEST(Format, OfAMissingFileIsAnInputError) {
  try {
    identify(std::filesystem::path("/nonexistent/a.ply"));
    FAIL();
  } catch (const FileError& error) {
    EXPECT_EQ(error.cause(), Cause::input);
    EXPECT_EQ(error.file(), "/nonexistent/a.ply");
  }
}

TEST(Format, NamesAreSuffixes) {
  EXPECT_EQ(name(Format::ply), "ply");
  EXPECT_EQ(name(Format::glb), "glb");
  EXPECT_EQ(name(Format::json_points), "json");
  EXPECT_EQ(name(Format::unknown), "unknown");
  for (const Format format : {Format::ply, Format::obj, Format::off, Format::stl, Format::las,
                              Format::vtu, Format::node, Format::gltf}) {
    EXPECT_EQ(format_of_suffix("x." + std::string(name(format))), format);
  }
}

}  // namespace
}  // namespace delray::files
