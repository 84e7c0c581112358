// Packs written, read back, and damaged.
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <random>
#include <sstream>
#include <thread>
#include <tuple>

#include "files/error.h"
#include "packs/check_pack.h"
#include "packs/pack_reader.h"
#include "packs/pack_writer.h"
#include "packs/unpack.h"
#include "parallel/arena.h"
#include "parallel/progress.h"
#include "scenes/generate.h"
#include "tests/raster/random_scene.h"
#include "tests/support/temporary_folder.h"

namespace delray::packs {
namespace {

std::string content_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream content;
  content << in.rdbuf();
  return content.str();
}

template <class T>
bool same_at(const std::vector<T>& a, std::uint32_t i, const std::vector<T>& b, std::uint32_t j) {
  if (a.empty() || b.empty()) return a.empty() == b.empty();
  return std::memcmp(&a[i], &b[j], sizeof(T)) == 0;
}

// The same triangles in the same order, with the same bits of everything at their corners.
void expect_same(const scenes::Mesh& a, const scenes::Mesh& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.material, b.material);
  ASSERT_EQ(a.triangles.size(), b.triangles.size());
  std::size_t differ = 0;
  for (std::size_t t = 0; t < a.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t i = a.triangles[t][k], j = b.triangles[t][k];
      const bool same = same_at(a.positions, i, b.positions, j) &&
                        same_at(a.normals, i, b.normals, j) && same_at(a.uvs, i, b.uvs, j) &&
                        same_at(a.uvs2, i, b.uvs2, j) && same_at(a.tangents, i, b.tangents, j) &&
                        same_at(a.colours, i, b.colours, j);
      differ += same ? 0 : 1;
    }
  }
  EXPECT_EQ(differ, 0U);
}

// As many of them, and f(a[i], b[i]) for each.
template <class T, class F>
void expect_each(const std::vector<T>& a, const std::vector<T>& b, F&& f) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) f(a[i], b[i]);
}

void expect_same(const scenes::Scene& a, const scenes::Scene& b) {
  expect_each(a.meshes, b.meshes,
              [](const scenes::Mesh& x, const scenes::Mesh& y) { expect_same(x, y); });
  expect_each(a.instances, b.instances, [](const auto& x, const auto& y) {
    EXPECT_EQ(std::tie(x.mesh, x.transform), std::tie(y.mesh, y.transform));
  });
  expect_each(a.materials, b.materials, [](const auto& x, const auto& y) {
    EXPECT_EQ(std::tie(x.base_colour, x.alpha, x.double_sided, x.attenuation_distance),
              std::tie(y.base_colour, y.alpha, y.double_sided, y.attenuation_distance));
    EXPECT_EQ(x.textures(), y.textures());
  });
  expect_each(a.textures, b.textures, [](const auto& x, const auto& y) {
    EXPECT_EQ(std::tie(x.width, x.srgb, x.wrap_u, x.set, x.radiance),
              std::tie(y.width, y.srgb, y.wrap_u, y.set, y.radiance));
    EXPECT_TRUE(x.texels == y.texels);
  });
  expect_each(a.lights, b.lights, [](const auto& x, const auto& y) {
    EXPECT_EQ(std::tie(x.kind, x.colour, x.position), std::tie(y.kind, y.colour, y.position));
  });
  expect_each(a.cameras, b.cameras, [](const auto& x, const auto& y) {
    EXPECT_EQ(std::tie(x.eye, x.vertical_fov, x.name), std::tie(y.eye, y.vertical_fov, y.name));
  });
  EXPECT_EQ(a.environment.texture, b.environment.texture);
  EXPECT_EQ(a.environment.zenith, b.environment.zenith);
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_EQ(a.z_up, b.z_up);
  EXPECT_EQ(a.framed, b.framed);
}

scenes::Scene full_scene(unsigned seed) {
  scenes::Scene scene = raster::with_second_uvs(raster::transparent_scene(seed, 700));
  scene.meshes[1].name = "second";
  scene.origin = {1e6, 2e6, -3};
  scene.z_up = seed % 2 == 1;
  scene.framed = {glm::vec3(-0.5F), glm::vec3(0.25F)};
  scene.cameras.push_back(raster::random_scene_camera());
  scene.cameras.back().name = "front";
  scenes::Texture sky;
  sky.width = 3;
  sky.height = 2;
  for (int i = 0; i < 6; ++i) sky.radiance.emplace_back(i, 0.1F * static_cast<float>(i), 1e6F);
  scene.environment.texture = static_cast<std::uint32_t>(scene.textures.size());
  scene.textures.push_back(sky);
  return scene;
}

TEST(Pack, HasTheSceneThatWasWritten) {
  const tests::TemporaryFolder folder;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = full_scene(seed);
    write_pack(folder / "a.pack", scene);
    ASSERT_TRUE(is_pack(folder / "a.pack"));
    PackReader pack(folder / "a.pack");
    const auto first = scenes::first_primitives(scene);
    EXPECT_TRUE(std::equal(first.begin(), first.end(), pack.first_primitives().begin(),
                           pack.first_primitives().end()));
    EXPECT_EQ(pack.vertices(), scenes::vertex_count(scene));
    expect_same(unpack(pack), scene);
  }
}

TEST(Pack, PagesAreBoundedAndHaveAsManyTrianglesAsFit) {
  const tests::TemporaryFolder folder;
  write_pack(folder / "a.pack", scenes::generate("gen:terrain:9000"));
  const PackReader pack(folder / "a.pack");
  std::size_t full = 0;
  for (std::uint32_t i = 0; i < pack.pages().size(); ++i) {
    const PageRow& row = pack.pages()[i];
    const Page page = pack.read(i);
    geometry::Box3 box;
    for (const glm::vec3& p : page.mesh.positions) box.include(p);
    EXPECT_EQ(box, row.box);
    ASSERT_EQ(page.clusters.size(), row.clusters);
    for (const PageCluster& cluster : page.clusters) {
      EXPECT_LE(cluster.count, kClusterTriangles);
      EXPECT_LE(cluster.vertices, kClusterVertices);
      for (std::uint32_t t = cluster.first; t < cluster.first + cluster.count; ++t) {
        const glm::uvec3& v = page.mesh.triangles[t];
        const auto at = [&](std::uint32_t k) { return glm::dvec3(page.mesh.positions[k]); };
        const glm::dvec3 normal = glm::normalize(glm::cross(at(v.y) - at(v.x), at(v.z) - at(v.x)));
        for (const NormalCone& cone : {cluster.cone, row.cone}) {
          if (cone.cosine == -1) continue;  // there is none
          EXPECT_GE(glm::dot(normal, glm::dvec3(cone.axis)), cone.cosine);
        }
      }
    }
    full += row.level == 0 && row.triangles == kPageClusters * kClusterTriangles ? 1 : 0;
  }
  EXPECT_GE(full, pack.meshes()[0].levels[0].count - 3);
}

TEST(Pack, IsTheSameFileForEveryNumberOfThreads) {
  const tests::TemporaryFolder folder;
  const scenes::Scene scene = scenes::generate("gen:terrain:9000");
  std::string expected;
  const parallel::AllowThreads allowed(5);
  for (const int threads : {1, 2, 5}) {
    parallel::Arena arena(threads);
    arena.execute([&] { write_pack(folder / "a.pack", scene); });
    const std::string content = content_of(folder / "a.pack");
    if (threads == 1) expected = content;
    EXPECT_EQ(content, expected) << threads;
  }
}

TEST(Pack, OddMeshesArePacked) {
  const tests::TemporaryFolder folder;
  scenes::Scene scene;
  scene.materials.emplace_back();
  scenes::Mesh mesh;  // triangles that share nothing, or everything, or have no area
  for (int i = 0; i < 3 * 300; ++i) mesh.positions.emplace_back(i % 7, i % 11, i % 13);
  for (std::uint32_t i = 0; i < 300; ++i) mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  for (std::uint32_t i = 0; i < 300; ++i) mesh.triangles.emplace_back(0, 1, 2);
  for (std::uint32_t i = 0; i < 9; ++i) mesh.triangles.emplace_back(i, i, i + 1);
  mesh.positions.emplace_back(-0.0F, 1e18F, 1e-44F);
  mesh.triangles.emplace_back(900, 0, 1);
  scene.meshes.push_back(mesh);
  scene.instances.push_back({});
  write_pack(folder / "a.pack", scene);
  PackReader pack(folder / "a.pack");
  expect_same(unpack(pack), scene);
  EXPECT_THROW(PackWriter(folder / "b.pack").add_mesh({}), std::invalid_argument);
  EXPECT_EQ(folder.entries(), 1U);  // what was not committed is gone
}

// What reading all of a file says: nothing, or the message.
std::string problem_of(const std::filesystem::path& path) {
  try {
    PackReader pack(path);
    unpack(pack);
    return "";
  } catch (const files::FileError& error) {
    EXPECT_EQ(error.cause(), files::Cause::input) << error.what();
    EXPECT_EQ(error.file(), path.string());
    return error.what();
  }
}

TEST(Pack, CutShortAnywhereIsAnError) {
  const tests::TemporaryFolder folder;
  write_pack(folder / "a.pack", raster::random_scene(3, 300));
  const std::string content = content_of(folder / "a.pack");
  for (std::size_t size = 0; size < content.size(); size += size < 200 ? 1 : 311) {
    const auto path = folder.write("cut.pack", content.substr(0, size));
    EXPECT_NE(problem_of(path), "") << size;
  }
  const auto path = folder.write("cut.pack", content.substr(0, content.size() - 1));
  EXPECT_NE(problem_of(path).find("cut short"), std::string::npos) << problem_of(path);
}

TEST(Pack, OfAnOlderVersionSaysWhatToDo) {
  const tests::TemporaryFolder folder;
  write_pack(folder / "a.pack", raster::random_scene(3, 300));
  std::string content = content_of(folder / "a.pack");
  content[8] = 3;
  const std::string problem = problem_of(folder.write("old.pack", content));
  EXPECT_NE(problem.find("of version 3"), std::string::npos) << problem;
  EXPECT_NE(problem.find("pack its scene again"), std::string::npos) << problem;
}

TEST(Pack, AFlippedBitAnywhereIsAnError) {
  const tests::TemporaryFolder folder;
  write_pack(folder / "a.pack", raster::random_scene(4, 300));
  const std::string content = content_of(folder / "a.pack");
  const unsigned seed = 20261124;
  std::mt19937 random(seed);
  for (int i = 0; i < 400; ++i) {
    std::string damaged = content;
    const std::size_t at = random() % damaged.size();
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << (random() % 8)));
    EXPECT_NE(problem_of(folder.write("damaged.pack", damaged)), "") << at << " seed " << seed;
  }
}

// Wherever it is asked to: while pages are cut, or after some of the levels.
TEST(Pack, LeavesNothingWhenItIsAskedToStop) {
  const tests::TemporaryFolder folder;
  const scenes::Scene scene = scenes::generate("gen:terrain:100000");
  parallel::Progress progress;
  write_pack(folder / "whole.pack", scene, {.progress = &progress});
  EXPECT_GT(progress.total(), 100U);
  EXPECT_GT(progress.done(), progress.total() / 2);
  std::filesystem::remove(folder / "whole.pack");
  for (const std::uint64_t pages : {0U, 20U}) {
    parallel::Progress stopped;
    std::jthread observer([&](const std::stop_token& ended) {
      while (stopped.done() < pages && !ended.stop_requested()) std::this_thread::yield();
      stopped.request_stop();
    });
    EXPECT_THROW(write_pack(folder / "a.pack", scene, {.progress = &stopped}),
                 parallel::Interrupted);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  }
}

TEST(Pack, SaysWhichPageIsDamaged) {
  const tests::TemporaryFolder folder;
  write_pack(folder / "a.pack", raster::random_scene(5, 2000), {.levels = false});
  std::uint64_t offset = 0;
  {
    const PackReader pack(folder / "a.pack");
    ASSERT_GT(pack.pages().size(), 4U);
    offset = pack.pages()[3].offset;
  }
  std::string content = content_of(folder / "a.pack");
  content[offset + 5] = static_cast<char>(content[offset + 5] ^ 1);
  const std::string problem = problem_of(folder.write("b.pack", content));
  EXPECT_NE(problem.find("page 3, byte " + std::to_string(offset)), std::string::npos) << problem;
}

TEST(CheckPack, NamesTheFirstPageThatIsDamaged) {
  const tests::TemporaryFolder folder;
  write_pack(folder / "a.pack", raster::random_scene(5, 4500), {.levels = false});
  std::string content = content_of(folder / "a.pack");
  {
    const PackReader pack(folder / "a.pack");
    check_pack(pack);
    ASSERT_GT(pack.pages().size(), 8U);
    for (const std::uint32_t page : {8U, 3U, 6U}) {
      const std::uint64_t place = pack.pages()[page].offset;
      content[place + 5] = static_cast<char>(content[place + 5] ^ 1);
    }
  }
  const PackReader damaged(folder.write("b.pack", content));
  try {
    check_pack(damaged);
    FAIL();
  } catch (const files::FileError& error) {
    EXPECT_NE(std::string(error.what()).find("page 3, byte"), std::string::npos) << error.what();
  }
}

TEST(Pack, OtherFilesAreNone) {
  const tests::TemporaryFolder folder;
  for (const std::string content : {"", "DELRAYP", "ply\n", "DELRAYPK\x01\0\0\0\0\0\0\0"}) {
    const auto path = folder.write("a.pack", content);
    EXPECT_NE(problem_of(path), "") << content;
  }
  EXPECT_NE(problem_of(folder / "none.pack"), "");
}

}  // namespace
}  // namespace delray::packs
