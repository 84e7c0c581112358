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

}  // namespace
}  // namespace delray::scenes
