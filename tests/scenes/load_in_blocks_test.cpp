// Files that are long enough to be read in several blocks: the same scene, and the same complaints,
// as a plain reading gives, for every coding and any number of threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <tuple>

#include "files/error.h"
#include "parallel/arena.h"
#include "scenes/load.h"
#include "scenes/scene.h"
#include "tests/scenes/sample_files.h"
#include "tests/support/temporary_folder.h"

namespace delray::scenes {
namespace {

constexpr std::uint32_t kSide = 230;  // of a grid of vertices; some 100000 triangles

// Polygons over a grid, in some order.
struct RandomModel {
  std::vector<glm::vec3> positions;
  std::vector<std::vector<std::uint32_t>> faces;
};

RandomModel random_grid(unsigned seed, bool quads) {
  std::mt19937 random(seed);
  RandomModel model;
  for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
    const auto z = static_cast<float>(random() % 1000) / 64;
    model.positions.emplace_back(i % kSide, i / kSide, z);
  }
  for (std::uint32_t i = 0; i + kSide + 1 < kSide * kSide; ++i) {
    if (i % kSide + 1 == kSide) continue;
    if (quads && random() % 3 == 0) {
      model.faces.push_back({i, i + 1, i + kSide + 1, i + kSide});
    } else {
      model.faces.push_back({i, i + 1, i + kSide});
      model.faces.push_back({i + 1, i + kSide + 1, i + kSide});
    }
  }
  std::shuffle(model.faces.begin(), model.faces.end(), random);
  return model;
}

std::string header(const RandomModel& model, const std::string& coding, const std::string& real) {
  return "ply\nformat " + coding + " 1.0\nelement vertex " +
         std::to_string(model.positions.size()) + "\nproperty " + real + " x\nproperty " + real +
         " y\nproperty " + real + " z\nelement face " + std::to_string(model.faces.size()) +
         "\nproperty list uchar int vertex_indices\nproperty uchar flag\nend_header\n";
}

template <class Real>
std::string binary_ply(const RandomModel& model, bool swap) {
  std::string ply = header(model, swap ? "binary_big_endian" : "binary_little_endian",
                           sizeof(Real) == 4 ? "float" : "double");
  for (const glm::vec3& p : model.positions) {
    for (int k = 0; k < 3; ++k) append(ply, static_cast<Real>(p[k]), swap);
  }
  for (const auto& face : model.faces) {
    append(ply, static_cast<std::uint8_t>(face.size()));
    for (const std::uint32_t v : face) append(ply, static_cast<std::int32_t>(v), swap);
    append(ply, std::uint8_t{7});
  }
  return ply;
}

std::string line_of(const glm::vec3& p) {
  return std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z);
}

std::string text_ply(const RandomModel& model, const std::string& end) {
  std::string ply = header(model, "ascii", "float");
  for (const glm::vec3& p : model.positions) ply += line_of(p) + end;
  for (const auto& face : model.faces) {
    ply += std::to_string(face.size());
    for (const std::uint32_t v : face) ply += " " + std::to_string(v);
    ply += " 7" + end;
  }
  return ply;
}

// With indices from the start or, `relative`, from the end.
std::string obj(const RandomModel& model, bool relative, const std::string& end) {
  std::string text;
  for (const glm::vec3& p : model.positions) text += "v " + line_of(p) + end;
  const auto n = static_cast<std::int64_t>(model.positions.size());
  for (const auto& face : model.faces) {
    text += "f";
    for (const std::int64_t v : face) text += " " + std::to_string(relative ? v - n : v + 1);
    text += end;
  }
  return text;
}

using Triangle = std::array<std::tuple<float, float, float>, 3>;

// How often there is each triangle, by its corners.
std::map<Triangle, int> triangles_of(const Scene& scene) {
  std::map<Triangle, int> result;
  for (const Mesh& mesh : scene.meshes) {
    for (const glm::uvec3& t : mesh.triangles) {
      Triangle triangle;
      for (int k = 0; k < 3; ++k) {
        const glm::vec3& p = mesh.positions[t[k]];
        triangle[static_cast<std::size_t>(k)] = {p.x, p.y, p.z};
      }
      ++result[triangle];
    }
  }
  return result;
}

std::map<Triangle, int> triangles_of(const RandomModel& model) {
  Scene scene;
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.positions = model.positions;
  for (const auto& face : model.faces) mesh.triangles.emplace_back(face[0], face[1], face[2]);
  return triangles_of(scene);
}

Scene load_with(const std::filesystem::path& path, int threads) {
  const parallel::AllowThreads allow(threads);
  parallel::Arena arena(threads);
  return arena.execute([&] {
    std::vector<std::string> warnings;
    Scene scene = load(path, warnings);
    for (const std::string& warning : warnings) ADD_FAILURE() << warning;
    return scene;
  });
}

void expect_same(const Scene& a, const Scene& b) {
  ASSERT_EQ(a.meshes.size(), b.meshes.size());
  for (std::size_t i = 0; i < a.meshes.size(); ++i) {
    EXPECT_TRUE(a.meshes[i].positions == b.meshes[i].positions);
    EXPECT_TRUE(a.meshes[i].triangles == b.meshes[i].triangles);
  }
  EXPECT_EQ(a.z_up, b.z_up);
}

TEST(LoadInBlocks, GivesTheTrianglesOfTheFileForEveryCoding) {
  constexpr unsigned kSeed = 5;
  const RandomModel model = random_grid(kSeed, false);
  const auto expected = triangles_of(model);
  const tests::TemporaryFolder folder;
  const std::map<std::string, std::string> files = {
      {"little.ply", binary_ply<float>(model, false)}, {"big.ply", binary_ply<float>(model, true)},
      {"double.ply", binary_ply<double>(model, true)}, {"text.ply", text_ply(model, "\n")},
      {"text_crlf.ply", text_ply(model, "\r\n")},
  };
  std::optional<Scene> first;
  for (const auto& [name, content] : files) {
    SCOPED_TRACE(name);
    const std::filesystem::path path = folder.write(name, content);
    const Scene scene = load_with(path, 1);
    EXPECT_TRUE(triangles_of(scene) == expected);
    if (!first) first = scene;
    expect_same(*first, scene);
    expect_same(scene, load_with(path, 5));
  }
}

TEST(LoadInBlocks, NumbersVerticesOfObjByTheirFirstCorners) {
  constexpr unsigned kSeed = 6;
  RandomModel model = random_grid(kSeed, false);
  const auto expected = triangles_of(model);
  for (int i = 0; i < 1000; ++i) model.positions.emplace_back(-1, -1, i);  // of no face
  const tests::TemporaryFolder folder;
  // Indices from the end are read line by line, the others are not.
  const Scene direct = load_with(folder.write("a.obj", obj(model, false, "\n")), 1);
  EXPECT_TRUE(triangles_of(direct) == expected);
  EXPECT_EQ(direct.meshes[0].positions.size(), std::size_t{kSide} * kSide);
  expect_same(direct, load_with(folder / "a.obj", 5));
  expect_same(direct, load_with(folder.write("b.obj", obj(model, true, "\n")), 3));
  expect_same(direct, load_with(folder.write("c.obj", obj(model, false, " \\\n # \r\n")), 3));
}

// Corners with texture coordinates and normals, in materials and polygons, over several ranges of
// the text: the same for every number of threads, and corner by corner what the lines say.
TEST(LoadInBlocks, JoinsCornersOfObjForAnyNumberOfThreads) {
  constexpr unsigned kSeed = 11;
  std::mt19937 random(kSeed);
  const RandomModel model = random_grid(kSeed, true);
  std::string text;
  for (const glm::vec3& p : model.positions) text += "v " + line_of(p) + "\n";
  for (int i = 0; i < 64; ++i) {
    text += "vt " + std::to_string(i) + " 0\nvn " + std::to_string(i + 1) + " 1 0\n";
  }
  std::size_t corners = 0, triangles = 0;
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    if (f % 20000 == 500) text += "usemtl m" + std::to_string(f % 3) + "\n";
    const bool normals = f % 5 != 0;
    text += "f";
    for (const std::uint32_t v : model.faces[f]) {
      const std::string one = std::to_string(v % 64 + 1), uv = random() % 9 == 0 ? "" : one;
      text += " " + std::to_string(v + 1) + "/" + uv + (normals ? "/" + one : "");
      ++corners;
    }
    triangles += model.faces[f].size() - 2;
    if (f % 1000 == 0) text += "\nl 1 2 3";
    text += "\n";
  }
  const tests::TemporaryFolder folder;
  const Scene one = load_with(folder.write("a.obj", text), 1);
  EXPECT_EQ(triangle_count(one), triangles);
  EXPECT_EQ(splat_count(one), 2 * ((model.faces.size() + 999) / 1000));
  for (const Mesh& mesh : one.meshes) {
    EXPECT_LT(mesh.positions.size(), corners);
    for (std::size_t i = 0; i < mesh.positions.size() && !mesh.normals.empty(); ++i) {
      const auto v = static_cast<std::uint32_t>(mesh.positions[i].x + mesh.positions[i].y * kSide);
      const glm::vec3 normal = glm::normalize(glm::vec3(v % 64 + 1, 1, 0));
      ASSERT_LT(glm::distance(mesh.normals[i], normal), 1e-6F);
      ASSERT_TRUE(mesh.uvs[i].x == static_cast<float>(v % 64) || mesh.uvs[i] == glm::vec2(0));
    }
  }
  const Scene five = load_with(folder / "a.obj", 5);
  expect_same(one, five);
  for (std::size_t m = 0; m < one.meshes.size(); ++m) {
    EXPECT_TRUE(one.meshes[m].normals == five.meshes[m].normals);
    EXPECT_TRUE(one.meshes[m].uvs == five.meshes[m].uvs);
    EXPECT_EQ(one.meshes[m].material, five.meshes[m].material);
  }
}

TEST(LoadInBlocks, CutsPolygonsAlikeInEveryCoding) {
  constexpr unsigned kSeed = 7;
  const RandomModel model = random_grid(kSeed, true);
  const tests::TemporaryFolder folder;
  const Scene first = load_with(folder.write("a.ply", binary_ply<float>(model, false)), 1);
  expect_same(first, load_with(folder / "a.ply", 5));
  expect_same(first, load_with(folder.write("b.ply", binary_ply<double>(model, true)), 3));
  expect_same(first, load_with(folder.write("c.ply", text_ply(model, "\n")), 3));
  EXPECT_TRUE(triangles_of(first) ==
              triangles_of(load_with(folder.write("d.obj", obj(model, false, "\n")), 3)));
}

// The complaint about a file that has `content`.
std::string complaint(const std::string& name, const std::string& content) {
  const tests::TemporaryFolder folder;
  const std::filesystem::path path = folder.write(name, content);
  const parallel::AllowThreads allow(3);
  parallel::Arena arena(3);
  try {
    std::vector<std::string> warnings;
    arena.execute([&] { return load(path, warnings); });
  } catch (const files::FileError& error) {
    EXPECT_EQ(error.cause(), files::Cause::input);
    const std::string what = error.what();
    return what.substr(what.find(name));
  }
  return "";
}

TEST(LoadInBlocks, TellsThePlaceOfTheFirstError) {
  constexpr unsigned kSeed = 8;
  RandomModel model = random_grid(kSeed, false);
  const std::size_t vertices = model.positions.size(), faces = model.faces.size();
  // Two, of which the second may be found first.
  const std::size_t wrong = faces * 3 / 4;
  model.faces[wrong][1] = model.faces[faces - 1][2] = static_cast<std::uint32_t>(vertices) + 5;
  const std::string what =
      "there is no vertex " + std::to_string(vertices + 5) + " (" + std::to_string(vertices);
  const std::string binary = binary_ply<float>(model, false);
  const std::size_t face = 14, body = binary.find("end_header\n") + 11;
  EXPECT_EQ(complaint("a.ply", binary).substr(0, 200),
            "a.ply: byte " + std::to_string(body + vertices * 12 + wrong * face + face - 1) + ": " +
                what + " vertices, from 0)");
  constexpr std::size_t kHeaderLines = 10;
  EXPECT_EQ(complaint("b.ply", text_ply(model, "\r\n")),
            "b.ply: line " + std::to_string(kHeaderLines + vertices + wrong + 1) + ": " + what +
                " vertices, from 0)");
  EXPECT_EQ(complaint("c.obj", obj(model, false, "\n")),
            "c.obj: line " + std::to_string(vertices + wrong + 1) + ": there is no vertex " +
                std::to_string(vertices + 6) + " (" + std::to_string(vertices) + " in all)");
}

TEST(LoadInBlocks, RefusesFilesThatEndEarly) {
  constexpr unsigned kSeed = 9;
  for (const bool quads : {false, true}) {
    const RandomModel model = random_grid(kSeed, quads);
    const std::string binary = binary_ply<float>(model, false), text = text_ply(model, "\n");
    EXPECT_NE(complaint("a.ply", binary.substr(0, binary.size() - 1)).find("ends before"),
              std::string::npos);
    EXPECT_NE(complaint("b.ply", text.substr(0, text.rfind('\n', text.size() - 2) + 1)),
              std::string());
    std::string nan = binary;
    const float value = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(&nan[nan.find("end_header\n") + 11 + 12 * 40000], &value, sizeof value);
    EXPECT_NE(complaint("c.ply", nan).find("not finite"), std::string::npos);
  }
}

}  // namespace
}  // namespace delray::scenes
