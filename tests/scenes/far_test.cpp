// Scenes far from the origin for their size: national grids, CAD, nodes with large translations.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "files/error.h"
#include "scenes/framing.h"
#include "scenes/load.h"
#include "scenes/write_glb.h"
#include "tests/scenes/sample_files.h"
#include "tests/support/temporary_folder.h"

namespace delray::scenes {
namespace {

Scene load_quietly(const std::filesystem::path& path) {
  std::vector<std::string> warnings;
  Scene scene = load(path, warnings);
  for (const std::string& w : warnings) ADD_FAILURE() << "warning: " << w;
  return scene;
}

std::vector<std::string> warnings_of(const std::filesystem::path& path) {
  std::vector<std::string> warnings;
  load(path, warnings);
  return warnings;
}

bool mentions(const std::vector<std::string>& warnings, const std::string& part) {
  return std::ranges::any_of(
      warnings, [&](const std::string& w) { return w.find(part) != std::string::npos; });
}

// A right-angled triangle with legs of a 64th, and what stands before and after its corners.
struct Corners {
  const char *name, *before, *between, *after;
};
constexpr Corners kFormats[] = {
    {"a.obj", "v ", "\nv ", "\nf 1 2 3\n"},
    {"a.off", "OFF 3 1 0\n", "\n", "\n3 0 1 2\n"},
    {"a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex ", "\nvertex ",
     "\nendloop\nendfacet\nendsolid a\n"},
    {"a.ply",
     "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
     "property double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n",
     "\n", "\n3 0 1 2\n"}};

TEST(Far, TextKeepsWhatDoublesCanHold) {
  const tests::TemporaryFolder folder;
  for (const Corners& f : kFormats) {
    const Scene scene = load_quietly(folder.write(
        f.name, std::string(f.before) + "512345 5412345.5 7" + f.between +
                    "512345.015625 5412345.5 7" + f.between + "512345 5412345.515625 7" + f.after));
    ASSERT_EQ(scene.meshes.size(), 1U) << f.name;
    const Mesh& mesh = scene.meshes[0];
    ASSERT_EQ(mesh.triangles.size(), 1U) << f.name;
    std::vector<glm::dvec3> corners;
    for (const glm::vec3& p : mesh.positions) corners.push_back(glm::dvec3(p) + scene.origin);
    std::ranges::sort(corners, {}, [](const glm::dvec3& p) { return p.x * 2 + p.y; });
    EXPECT_EQ(corners, (std::vector<glm::dvec3>{{512345, 5412345.5, 7},
                                                {512345, 5412345.515625, 7},
                                                {512345.015625, 5412345.5, 7}}))
        << f.name;
    EXPECT_LE(glm::length(scene.meshes[0].positions[0]), 1) << f.name;
  }
}

TEST(Far, NearScenesKeepTheirCoordinates) {
  const tests::TemporaryFolder folder;
  for (const SampleFile& file : sample_files()) {
    std::vector<std::string> ignored;
    EXPECT_EQ(load(folder.write(file.name, file.content), ignored).origin, glm::dvec3(0))
        << file.name;
  }
  for (const Corners& f : kFormats) {
    const Scene scene =
        load_quietly(folder.write(f.name, std::string(f.before) + "60 0 0" + f.between + "61 0 0" +
                                              f.between + "60 1 0" + f.after));
    EXPECT_EQ(scene.origin, glm::dvec3(0)) << f.name;
    EXPECT_EQ(bounds(scene), (geometry::Box3{{60, 0, 0}, {61, 1, 0}})) << f.name;
  }
}

TEST(Far, SinglePrecisionIsToldWhereItsStepsShow) {
  const tests::TemporaryFolder folder;
  const auto stl = [&](float x) {
    std::string bytes(80, ' ');
    append(bytes, std::uint32_t{1});
    for (const float value : {0.0F, 0.0F, 1.0F, x, 0.0F, 0.0F, x + 1, 0.0F, 0.0F, x, 1.0F, 0.0F}) {
      append(bytes, value);
    }
    append(bytes, std::uint16_t{0});
    return folder.write("a.stl", bytes);
  };
  EXPECT_TRUE(warnings_of(stl(1000)).empty());
  EXPECT_TRUE(mentions(warnings_of(stl(1e6F)), "single precision"));
  std::vector<std::string> warnings;
  const Scene scene = load(stl(1e6F), warnings);
  EXPECT_EQ(scene.origin, glm::dvec3(1e6 + 0.5, 0.5, 0));
  EXPECT_EQ(bounds(scene), (geometry::Box3{{-0.5F, -0.5F, 0}, {0.5F, 0.5F, 0}}));
}

TEST(Far, TinyScenesAtTheOriginAreNotFar) {
  const tests::TemporaryFolder folder;
  const Scene scene =
      load_quietly(folder.write("a.obj", "v 0 0 0\nv 1e-30 0 0\nv 0 1e-30 0\nf 1 2 3\n"));
  EXPECT_EQ(scene.origin, glm::dvec3(0));
}

// Replaces the first `from` of `text`.
std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

// Nodes 0 and 1 have the mesh, node 2 a camera, node 3 a light.
std::string gltf(const std::string& first_translation, const std::string& second) {
  std::string text = with(sample_gltf(), "\"translation\":[1,2,3],\"children\":[1]}",
                          "\"translation\":[" + first_translation + "],\"children\":[1,2,3]}");
  text = with(text, "\"scale\":[2,2,2]}",
              "\"translation\":[" + second +
                  R"(]},{"camera":0,"translation":[0,0,20]},
{"translation":[0,8,0],"extensions":{"KHR_lights_punctual":{"light":0}}})");
  return with(text, "\"asset\"",
              R"("cameras":[{"type":"perspective","perspective":{"yfov":1}}],
"extensionsUsed":["KHR_lights_punctual"],
"extensions":{"KHR_lights_punctual":{"lights":[{"type":"point"}]}},"asset")");
}

TEST(Far, GltfNodesAreComposedInDoublePrecision) {
  const tests::TemporaryFolder folder;
  const Scene scene = load_quietly(folder.write("a.gltf", gltf("1e9,0.25,-1e9", "0.0625,0,0")));
  ASSERT_EQ(scene.instances.size(), 2U);
  EXPECT_EQ(scene.instances[1].transform[3] - scene.instances[0].transform[3],
            glm::vec3(0.0625F, 0, 0));
  const geometry::Box3 box = bounds(scene);
  EXPECT_EQ(glm::dvec3(box.low) + scene.origin, glm::dvec3(1e9, 0.25, -1e9));
  EXPECT_EQ(glm::dvec3(box.high) + scene.origin, glm::dvec3(1e9 + 1.0625, 1.25, 1 - 1e9));
  ASSERT_EQ(scene.cameras.size(), 1U);
  EXPECT_EQ(glm::dvec3(scene.cameras[0].eye) + scene.origin, glm::dvec3(1e9, 0.25, 20 - 1e9));
  ASSERT_EQ(scene.lights.size(), 1U);
  EXPECT_EQ(glm::dvec3(scene.lights[0].position) + scene.origin, glm::dvec3(1e9, 8.25, -1e9));
}

TEST(Far, GltfNodesThatCancelLargeVerticesLeaveThemNear) {
  const tests::TemporaryFolder folder;
  std::string bytes;
  for (const int x : {0, 0, 0, 4, 0, 0, 4, 4, 0, 0, 4, 0, 0, 0, 4}) {
    append(bytes, static_cast<float>(x) + 4194304.0F);
  }
  const std::string near = gltf("-4194304,-4194304,-4194304", "0,0,8");
  const std::size_t begin = near.find("base64,") + 7, end = near.find('"', begin);
  std::string bytes_of_indices;
  for (const int i : {0, 1, 2, 0, 2, 3, 0, 1, 4})
    append(bytes_of_indices, static_cast<std::uint16_t>(i));
  std::string far = near;
  far.replace(begin, end - begin, base64(bytes + bytes_of_indices));
  std::vector<std::string> warnings;
  const Scene scene = load(folder.write("a.gltf", far), warnings);
  EXPECT_TRUE(mentions(warnings, "single precision"));
  EXPECT_EQ(scene.origin, glm::dvec3(0));
  EXPECT_EQ(bounds(scene), (geometry::Box3{{0, 0, 0}, {4, 4, 12}}));
  for (const glm::vec3& p : scene.meshes[0].positions) EXPECT_LE(glm::length(p), 4);
}

TEST(Far, GlbKeepsTheOrigin) {
  const tests::TemporaryFolder folder;
  Scene scene = load_quietly(folder.write("a.gltf", gltf("1e9,0.25,-1e9", "0.0625,0,0")));
  scene.lights.push_back(
      {.kind = Light::Kind::area, .position = {1, 2, 3}, .edge_u = {1, 0, 0}, .edge_v = {0, 1, 0}});
  write_glb(folder / "b.glb", scene);
  const Scene again = load_quietly(folder / "b.glb");
  EXPECT_EQ(again.origin, scene.origin);
  EXPECT_EQ(bounds(again), bounds(scene));
  EXPECT_EQ(again.cameras[0].eye, scene.cameras[0].eye);
  ASSERT_EQ(again.lights.size(), 2U);
  EXPECT_EQ(again.lights[0].position, scene.lights[0].position);
  EXPECT_EQ(again.lights[1].position, scene.lights[1].position);
}

TEST(Far, TooFarIsAnErrorStill) {
  const tests::TemporaryFolder folder;
  for (const char* translation : {"1e19,0,0", "1e300,0,0"}) {
    EXPECT_THROW(load_quietly(folder.write("a.gltf", gltf(translation, "0,0,0"))),
                 files::FileError);
  }
}

}  // namespace
}  // namespace delray::scenes
