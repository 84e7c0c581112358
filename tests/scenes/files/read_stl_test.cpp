#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "files/error.h"
#include "scenes/files/load_content.h"
#include "tests/scenes/sample_files.h"

namespace delray::scenes {
namespace {

Mesh read_stl_text(const std::string& content) {
  std::vector<std::string> warnings;
  return internal::load_content("/nowhere/a.stl", content, warnings).meshes.at(0);
}

TEST(ReadStl, ColoursOfFacets) {
  EXPECT_TRUE(read_stl_text(sample_stl_binary()).colours.empty());
  std::string stl = sample_stl_binary();
  stl.replace(84 + 48, 2, std::string("\x1F\x80", 2));  // the lowest five bits, and the highest
  Mesh mesh = read_stl_text(stl);
  EXPECT_EQ(mesh.colours[mesh.triangles[0].x], glm::vec4(0, 0, 1, 1));
  EXPECT_NE(mesh.colours[mesh.triangles[1].x], glm::vec4(0, 0, 1, 1));
  stl.replace(10, 10, std::string("COLOR=\0\xFF\0\xFF", 10));
  mesh = read_stl_text(stl);
  EXPECT_EQ(mesh.colours[mesh.triangles[0].x], glm::vec4(1, 0, 0, 1));
  EXPECT_EQ(mesh.colours[mesh.triangles[1].x], glm::vec4(0, 1, 0, 1));
}

TEST(ReadStl, CornersBesideTheirFacets) {
  EXPECT_THROW(read_stl_text("solid\nvertex 0 0 0\nendfacet\nendsolid\n"), files::FileError);
  const std::string corners = "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n";
  EXPECT_EQ(read_stl_text("solid\nfacet\n" + corners + "facet\n" + corners + "endfacet\nendsolid\n")
                .triangles.size(),
            1U);
}

// So many facets, the n-th of them at (n, n, n), in text of several ranges; odd ones are indented
// and have more words than they need.
std::string many_facets(int count) {
  std::string text = "solid many\n";
  for (int i = 0; i < count; ++i) {
    const std::string at = std::to_string(i), blanks(static_cast<std::size_t>(i % 7), ' ');
    text += blanks + "facet normal 0 0 1\n" + blanks + "outer loop\n";
    for (const char* corner : {".25 ", ".5 ", ".75 "})
      text += blanks + "vertex " + at + corner + at + " " + at + "\n";
    text += blanks + "endloop\n" + blanks + "endfacet\n";
  }
  return text + "endsolid many\n";
}

TEST(ReadStl, TextOfSeveralRanges) {
  constexpr int kCount = 30000;
  const std::string text = many_facets(kCount);
  ASSERT_GT(text.size(), std::size_t{4} << 20);
  std::vector<std::string> warnings;
  const Scene scene = internal::load_content("/nowhere/a.stl", text, warnings);
  const Mesh& mesh = scene.meshes.at(0);
  ASSERT_EQ(mesh.triangles.size(), std::size_t{kCount});
  for (int i = 0; i < kCount; ++i) {
    const glm::uvec3& t = mesh.triangles[static_cast<std::size_t>(i)];
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 p = glm::dvec3(mesh.positions[t[k]]) + scene.origin;
      ASSERT_EQ(p, glm::dvec3(i + 0.25 * (k + 1), i, i)) << i;
    }
  }
}

TEST(ReadStl, TextOfSeveralRangesNamesTheLineThatIsWrong) {
  const std::string text = many_facets(30000);
  const auto wrong = [&](const std::string& content) {
    std::vector<std::string> warnings;
    try {
      internal::load_content("/nowhere/a.stl", content, warnings);
    } catch (const files::FileError& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  const std::size_t middle = text.find("\n", text.find("vertex 20000.5"));
  const std::string line = std::to_string(1 + 7 * 20000 + 4);
  std::string changed = text;
  changed[middle - 1] = 'x';
  EXPECT_NE(wrong(changed).find("line " + line + ":"), std::string::npos) << wrong(changed);
  changed = text;
  changed.erase(text.rfind('\n', middle - 1), middle - text.rfind('\n', middle - 1));
  const std::string end = std::to_string(1 + 7 * 20000 + 6);
  EXPECT_NE(wrong(changed).find("line " + end + ": the facet has 2 vertices"), std::string::npos)
      << wrong(changed);
  const std::string open = text.substr(0, text.rfind("endsolid"));
  EXPECT_NE(wrong(open).find("line " + std::to_string(1 + 7 * 30000) + ": the file ends before"),
            std::string::npos)
      << wrong(open);
  // A facet that begins in one range, and ends after several.
  const std::string long_comment(std::size_t{2} << 20, '\n');
  changed = text;
  changed.insert(middle, long_comment);
  EXPECT_EQ(read_stl_text(changed).triangles.size(), 30000U);
}

}  // namespace
}  // namespace delray::scenes
