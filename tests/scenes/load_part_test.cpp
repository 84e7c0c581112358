// The parts that ranks read of a file are the whole scene, bit for bit, and no more than it.
#include "scenes/load_part.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <mutex>
#include <random>

#include "comm/threads.h"
#include "parallel/arena.h"
#include "scenes/load.h"
#include "scenes/write_glb.h"
#include "tests/scenes/sample_files.h"
#include "tests/support/temporary_folder.h"

namespace delray::scenes {
namespace {

// A bumpy strip of n columns of triangles, column by column, with creases and pairs of vertices in
// one place.
Mesh strip(std::uint32_t n, unsigned seed) {
  constexpr std::uint32_t kRows = 9;
  std::mt19937 random(seed);
  Mesh mesh;
  for (std::uint32_t x = 0; x < n; ++x) {
    for (std::uint32_t y = 0; y < kRows; ++y) {
      const float z = static_cast<float>(random() % 1000) / 700;
      mesh.positions.emplace_back(x, y, z);
      // The seam of a column.
      if (y == 4 && x > 0 && x % 3 == 0)
        mesh.positions.back() = mesh.positions[mesh.positions.size() - 1 - kRows];
    }
  }
  for (std::uint32_t x = 0; x + 1 < n; ++x) {
    for (std::uint32_t y = 0; y + 1 < kRows; ++y) {
      const std::uint32_t i = x * kRows + y;
      mesh.triangles.emplace_back(i, i + kRows, i + 1);
      mesh.triangles.emplace_back(i + 1, i + kRows, i + kRows + 1);
    }
  }
  return mesh;
}

void drop_seams(Mesh& mesh) {
  for (std::uint32_t i = 0; i < mesh.positions.size(); ++i)
    mesh.positions[i].x = std::floor(i / 9.0F);
}

struct PlyLook {
  bool swap = false, normals = false, colours = false, zero_normal = false;
  double far = 0;
  std::string comment = {};
};

std::string ply_of(const Mesh& mesh, const PlyLook& look) {
  std::string ply = std::string("ply\nformat binary_") + (look.swap ? "big" : "little") +
                    "_endian 1.0\n" + look.comment + "element vertex " +
                    std::to_string(mesh.positions.size()) +
                    "\nproperty float x\nproperty float y\nproperty float z\n";
  if (look.normals) ply += "property float nx\nproperty float ny\nproperty float nz\n";
  if (look.colours) ply += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  ply += "element face " + std::to_string(mesh.triangles.size()) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    for (int k = 0; k < 3; ++k)
      append(ply, mesh.positions[i][k] + static_cast<float>(look.far), look.swap);
    if (look.normals) {
      const bool none = look.zero_normal && i == 700;
      for (const float n : {none ? 0.0F : 3.0F, none ? 0.0F : static_cast<float>(i), 0.0F})
        append(ply, n, look.swap);
    }
    if (look.colours)
      for (int k = 0; k < 3; ++k) append(ply, static_cast<std::uint8_t>(i * 7 + k));
  }
  for (const glm::uvec3& t : mesh.triangles) {
    append(ply, std::uint8_t{3});
    for (int k = 0; k < 3; ++k) append(ply, static_cast<std::int32_t>(t[k]), look.swap);
  }
  return ply;
}

void save(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

// The parts of all ranks; empty where there are none.
std::vector<ScenePart> parts_of(const std::filesystem::path& path, int ranks,
                                std::vector<std::string>* warnings = nullptr) {
  std::vector<std::optional<ScenePart>> parts(static_cast<std::size_t>(ranks));
  comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
    std::vector<std::string> own;
    parts[static_cast<std::size_t>(communicator.rank())] = load_part(communicator, path, own);
    if (communicator.rank() == 0 && warnings != nullptr) *warnings = own;
    EXPECT_TRUE(communicator.rank() == 0 || own.empty());
  });
  std::vector<ScenePart> result;
  for (auto& part : parts)
    if (part) result.push_back(*std::move(part));
  EXPECT_TRUE(result.empty() || result.size() == parts.size());
  return result;
}

template <class T>
bool same(const std::vector<T>& a, std::uint32_t i, const std::vector<T>& b, std::uint32_t j) {
  return a.empty() ? b.empty() : !b.empty() && std::memcmp(&a[i], &b[j], sizeof(T)) == 0;
}

// Compares parts with the whole of a file for several numbers of ranks.
void expect_whole(const std::filesystem::path& path) {
  std::vector<std::string> expected_warnings;
  Scene whole = load(path, expected_warnings);
  const std::size_t vertices = whole.meshes[0].positions.size();
  complete_surfaces(whole);
  const Mesh& mesh = whole.meshes[0];
  for (const int ranks : {1, 2, 3, 5}) {
    SCOPED_TRACE(path.filename().string() + ", " + std::to_string(ranks) + " ranks");
    std::vector<std::string> warnings;
    const std::vector<ScenePart> parts = parts_of(path, ranks, &warnings);
    ASSERT_FALSE(parts.empty());
    EXPECT_EQ(warnings, expected_warnings);
    std::size_t next = 0;
    for (const ScenePart& part : parts) {
      EXPECT_EQ(part.first_triangle, next);
      EXPECT_EQ(part.triangles, mesh.triangles.size());
      EXPECT_EQ(part.vertices, vertices);
      EXPECT_EQ(part.scene.origin, whole.origin);
      EXPECT_EQ(part.scene.z_up, whole.z_up);
      EXPECT_EQ(part.scene.materials[0].base_colour, whole.materials[0].base_colour);
      EXPECT_EQ(part.scene.files, whole.files);
      ASSERT_EQ(part.scene.instances.size(), 1U);
      EXPECT_EQ(part.scene.instances[0].transform, whole.instances[0].transform);
      const Mesh& piece = part.scene.meshes[0];
      EXPECT_EQ(piece.material, mesh.material);
      for (const glm::uvec3& t : piece.triangles) {
        ASSERT_LT(next, mesh.triangles.size());
        const glm::uvec3& v = mesh.triangles[next];
        for (int k = 0; k < 3; ++k) {
          ASSERT_TRUE(same(piece.positions, t[k], mesh.positions, v[k])) << next;
          ASSERT_TRUE(same(piece.normals, t[k], mesh.normals, v[k])) << next;
          ASSERT_TRUE(same(piece.colours, t[k], mesh.colours, v[k])) << next;
          ASSERT_TRUE(same(piece.uvs, t[k], mesh.uvs, v[k])) << next;
        }
        ++next;
      }
      // Nearly an equal share of both, but for the columns at the borders and copies at creases.
      const auto n = static_cast<std::size_t>(ranks);
      EXPECT_LE(piece.triangles.size(), mesh.triangles.size() / n + 256);
      EXPECT_LE(piece.positions.size(), mesh.positions.size() / n + 512);
    }
    EXPECT_EQ(next, mesh.triangles.size());
  }
}

const parallel::AllowThreads kAllow(5);

TEST(LoadPart, OfPlyIsTheWhole) {
  const tests::TemporaryFolder folder;
  Mesh mesh = strip(500, 1);
  drop_seams(mesh);
  int number = 0;
  const PlyLook looks[] = {{},
                           {.swap = true, .colours = true, .comment = "comment up: z\n"},
                           {.normals = true},
                           {.normals = true, .zero_normal = true},
                           {.colours = true, .far = 1e6}};
  for (const PlyLook& look : looks) {
    const auto path = folder.path() / (std::to_string(number++) + ".ply");
    save(path, ply_of(mesh, look));
    expect_whole(path);
  }
}

TEST(LoadPart, LeavesOutDegenerateTriangles) {
  const tests::TemporaryFolder folder;
  Mesh mesh = strip(500, 2);  // with seams, where triangles have two corners in one place
  save(folder.path() / "seams.ply", ply_of(mesh, {}));
  expect_whole(folder.path() / "seams.ply");
  // At the beginning, at the end, and where parts meet.
  drop_seams(mesh);
  for (const std::size_t t : {std::size_t{0}, std::size_t{1}, mesh.triangles.size() / 2,
                              mesh.triangles.size() / 3 / 128 * 128, mesh.triangles.size() - 1}) {
    mesh.triangles[t].y = mesh.triangles[t].x;
  }
  save(folder.path() / "some.ply", ply_of(mesh, {}));
  expect_whole(folder.path() / "some.ply");
}

TEST(LoadPart, OfGlbIsTheWhole) {
  const tests::TemporaryFolder folder;
  Scene scene;
  scene.meshes.push_back(strip(500, 3));
  scene.materials.resize(2);
  scene.materials[1].base_colour = {0.1F, 0.5F, 0.9F, 1};
  scene.meshes[0].material = 1;
  scene.instances.push_back({0, glm::mat4x3(1.0F)});
  scene.instances[0].transform[3] = {3, 4, 5};
  scene.cameras.push_back({});
  scene.lights.push_back({});
  write_glb(folder.path() / "bare.glb", scene);
  expect_whole(folder.path() / "bare.glb");
  for (std::size_t i = 0; i < scene.meshes[0].positions.size(); ++i) {
    scene.meshes[0].normals.emplace_back(0, 0, 1);
    scene.meshes[0].uvs.emplace_back(i, 2 * i);
    scene.meshes[0].colours.emplace_back(1, 0.5F, 1.0F / static_cast<float>(i + 1), 1);
  }
  write_glb(folder.path() / "all.glb", scene);
  expect_whole(folder.path() / "all.glb");
}

TEST(LoadPart, LeavesOthersToLoad) {
  const tests::TemporaryFolder folder;
  Mesh mesh = strip(500, 4);
  const auto path = folder.path() / "a.ply";
  const auto none = [&](const std::string& bytes) {
    save(path, bytes);
    return parts_of(path, 3).empty();
  };
  drop_seams(mesh);
  std::string good = ply_of(mesh, {});
  EXPECT_FALSE(none(good));
  EXPECT_TRUE(none(good.substr(0, good.size() - 1)));
  EXPECT_TRUE(none(sample_ply_text()));
  EXPECT_TRUE(none(sample_ply_binary(false)));  // too few
  EXPECT_TRUE(none(sample_gltf()));
  EXPECT_TRUE(none(""));
  Mesh wrong = mesh;
  wrong.triangles[1234].y = 1U << 30;
  EXPECT_TRUE(none(ply_of(wrong, {})));
  wrong = mesh;
  wrong.positions[40].x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(none(ply_of(wrong, {})));
  // Such an order is changed.
  wrong = mesh;
  std::shuffle(wrong.triangles.begin(), wrong.triangles.end(), std::mt19937(5));
  EXPECT_TRUE(none(ply_of(wrong, {})));
  Scene twice;
  twice.meshes.push_back(mesh);
  twice.materials.resize(1);
  twice.instances = {{0, glm::mat4x3(1.0F)}, {0, glm::mat4x3(2.0F)}};
  write_glb(folder.path() / "twice.glb", twice);
  EXPECT_TRUE(parts_of(folder.path() / "twice.glb", 2).empty());
  // What moves is posed as a whole.
  Scene moving;
  moving.meshes.push_back(mesh);
  moving.materials.resize(1);
  moving.instances.push_back({0, glm::mat4x3(1.0F)});
  write_glb(folder.path() / "moving.glb", moving);
  EXPECT_FALSE(parts_of(folder.path() / "moving.glb", 2).empty());
  moving.animations.nodes.resize(1);
  moving.animations.animations.push_back(
      {"shift", {{AnimationChannel::Path::translation, {}, 0, 3, {0, 1}, {0, 0, 0, 1, 0, 0}}}});
  moving.animations.instances.push_back({0, 0, glm::dvec3(0)});
  write_glb(folder.path() / "moving.glb", moving);
  EXPECT_TRUE(parts_of(folder.path() / "moving.glb", 2).empty());
}

}  // namespace
}  // namespace delray::scenes
