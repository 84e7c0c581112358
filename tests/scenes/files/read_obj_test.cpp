#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "files/error.h"
#include "scenes/files/load_content.h"
#include "scenes/files/read_mtl.h"
#include "scenes/scene.h"

namespace delray::scenes {
namespace {

struct Loaded {
  Scene scene;
  std::vector<std::string> warnings;
};

Loaded read_obj_text(const std::string& content) {
  Loaded result;
  result.scene = internal::load_content("/nowhere/a.obj", content, result.warnings);
  return result;
}

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(ReadObj, GroupsAndObjectsAreOneMesh) {
  const Loaded l =
      read_obj_text("o a\n" + kSquare + "g x\nf 1 2 3\ng y z\nf 1 3 4\no b\nf 1 2 4\n");
  ASSERT_EQ(l.scene.meshes.size(), 1U);
  EXPECT_EQ(l.scene.meshes[0].triangles,
            (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}, {0, 1, 3}}));
  EXPECT_EQ(l.scene.instances.size(), 1U);
}

// A step for each group before would take hours.
TEST(ReadObj, HalfAMillionGroups) {
  constexpr int kGroups = 500'000;
  std::string obj = kSquare;
  for (int i = 0; i < kGroups; ++i) obj += "g " + std::to_string(i) + "\nf 1 2 3\n";
  EXPECT_EQ(triangle_count(read_obj_text(obj).scene), std::uint64_t{kGroups});
}

TEST(ReadObj, HalfAMillionMaterialsAndTextureCoordinatesOfOneVertex) {
  constexpr int kMany = 500'000;
  std::string obj = kSquare;
  for (int i = 0; i < kMany; ++i) {
    obj += "vt " + std::to_string(i) + " 0\nf 1/-1 2/-1 3/-1\n";
  }
  const Loaded l = read_obj_text(obj);
  EXPECT_EQ(l.scene.meshes.at(0).positions.size(), 3U * kMany);
  obj = kSquare;
  for (int i = 0; i < kMany / 10; ++i) obj += "usemtl m" + std::to_string(i) + "\nf 1 2 3\n";
  EXPECT_EQ(read_obj_text(obj).scene.meshes.size(), std::size_t{kMany / 10});
}

TEST(ReadObj, APolygonOfAHundredThousandCorners) {
  constexpr int kCorners = 100'000;
  std::string obj, face = "f";
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCorners, radius = i % 2 == 0 ? 1 : 0.5;
    obj += "v " + std::to_string(radius * std::cos(angle)) + " " +
           std::to_string(radius * std::sin(angle)) + " 0\n";
    face += " " + std::to_string(i + 1);
  }
  EXPECT_EQ(triangle_count(read_obj_text(obj + face + "\n").scene), kCorners - 2U);
}

TEST(ReadObj, LinesAndPointsAreMeshesOfTheirOwn) {
  const Loaded l = read_obj_text(kSquare +
                                 "usemtl a\nl 1 2 3\nf 1 2 3\np 4 2\nusemtl b\nl 3 4\nl -1/1 -2\n"
                                 "vt 0 0\np 1\nusemtl a\nl 1 4\n");
  EXPECT_TRUE(l.warnings.empty());
  EXPECT_EQ(triangle_count(l.scene), 1U);
  EXPECT_EQ(splat_count(l.scene), 8U);
  ASSERT_EQ(l.scene.meshes.size(), 5U);
  using Kind = Shape::Kind;
  const Kind kinds[] = {Kind::line, Kind::triangle, Kind::point, Kind::line, Kind::point};
  for (std::size_t m = 0; m < 5; ++m) {
    const Mesh& mesh = l.scene.meshes[m];
    EXPECT_EQ(mesh.shape.kind, kinds[m]) << m;
    EXPECT_EQ(mesh.name, m < 3 ? "a" : "b") << m;
    EXPECT_EQ(l.scene.materials[mesh.material].unlit, kinds[m] != Kind::triangle) << m;
  }
  EXPECT_EQ(l.scene.meshes[0].triangles,
            (std::vector<glm::uvec3>{{0, 1, 1}, {1, 2, 2}, {0, 3, 3}}));
  EXPECT_EQ(l.scene.meshes[2].positions, (std::vector<glm::vec3>{{0, 1, 0}, {1, 0, 0}}));
  EXPECT_EQ(l.scene.meshes[3].triangles, (std::vector<glm::uvec3>{{0, 1, 1}, {1, 0, 0}}));
  EXPECT_EQ(splat_count(read_obj_text(kSquare + "p 1 2 3 4\n").scene), 4U);
  EXPECT_THROW(read_obj_text(kSquare + "l 1 5\n"), files::FileError);
}

TEST(ReadObj, ShortElementsAndFreeFormsAreLeftOutWithAWarning) {
  const Loaded l =
      read_obj_text(kSquare + "l 1\nf 1 2\nf 1 2 3\ncurv 0 1 1 2 3\nsurf 0 1 0 1 1 2\n");
  EXPECT_EQ(triangle_count(l.scene), 1U);
  ASSERT_EQ(l.warnings.size(), 2U);
  EXPECT_NE(l.warnings[0].find("2 faces of fewer than 3 corners"), std::string::npos);
  EXPECT_NE(l.warnings[1].find("2 free-form"), std::string::npos);
}

TEST(ReadObj, ColoursOfVerticesAndWeights) {
  const Loaded l = read_obj_text("v 0 0 0 1 0 0\nv 1 0 0 1\nv 0 1 0 0 0 1\nv 5 5 5\nf 1 2 3\n");
  const Mesh& mesh = l.scene.meshes.at(0);
  EXPECT_EQ(mesh.colours, (std::vector<glm::vec4>{{1, 0, 0, 1}, {1, 1, 1, 1}, {0, 0, 1, 1}}));
  EXPECT_EQ(mesh.positions[1], glm::vec3(1, 0, 0));
  EXPECT_EQ(l.scene.materials[mesh.material].base_colour, glm::vec4(1));
  EXPECT_TRUE(read_obj_text(kSquare + "f 1 2 3\n").scene.meshes.at(0).colours.empty());
}

TEST(ReadObj, FacesWithoutNormalsDoNotCostOthersTheirs) {
  const Loaded l = read_obj_text(kSquare + "vn 0 0 2\nf 1//1 2//1 3//1\nf 1 3 4\nf 1//1 2 4//1\n");
  ASSERT_EQ(l.scene.meshes.size(), 2U);
  EXPECT_EQ(l.scene.meshes[0].normals, std::vector<glm::vec3>(3, glm::vec3(0, 0, 1)));
  EXPECT_TRUE(l.scene.meshes[1].normals.empty());
  EXPECT_EQ(l.scene.meshes[1].triangles.size(), 2U);
}

TEST(ReadObj, IndicesBackFromTheLineAndForwardToLaterVertices) {
  const Loaded l = read_obj_text("f 1 2 3\n" + kSquare + "f -4 -2 -1 # a comment\n");
  EXPECT_EQ(l.scene.meshes.at(0).positions[1], glm::vec3(1, 0, 0));
  EXPECT_EQ(triangle_count(l.scene), 2U);
  EXPECT_THROW(read_obj_text("f -1 -2 -3\n" + kSquare), files::FileError);
}

TEST(ReadMtl, NumbersColoursAndMapsWithOptions) {
  Scene scene;
  std::vector<std::string> warnings;
  const internal::Source source{"/nowhere/a.obj", "", warnings};
  internal::TextureFiles textures(source, scene.textures);
  const std::vector<Material> m = internal::read_mtl(
      "Kd 1 1 1\nnewmtl  first one \r\nKd 1 0\nPr 0.25\nPm 0.5\nTr 0.75\n"
      "newmtl b\nmap_Kd -s 1 1 1 -o 0 -clamp on -bm 2 my wall.png\nd -halo 0.5\nKs 1 1 1\n"
      "newmtl c\nKd x y z\nNi 99\nd 0\nNs nan\n",
      textures);
  ASSERT_EQ(m.size(), 3U);
  EXPECT_EQ(m[0].name, "first one");
  EXPECT_EQ(m[0].base_colour, glm::vec4(1, 0, 0, 0.25F));
  EXPECT_EQ(m[0].roughness, 0.25F);
  EXPECT_EQ(m[0].metallic, 0.5F);
  EXPECT_EQ(m[1].base_colour.a, 0.5F);
  EXPECT_EQ(m[1].roughness, 1.0F);
  EXPECT_NEAR(m[2].base_colour.x, 0.3185, 1e-3);
  EXPECT_EQ(m[2].ior, 1.5F);
  EXPECT_EQ(m[2].alpha, Material::Alpha::opaque);
  EXPECT_EQ(m[2].roughness, 0.8F);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find(": my wall.png: "), std::string::npos) << warnings[0];
}

}  // namespace
}  // namespace delray::scenes
