#include "raster/pipeline/draws.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace delray::raster {
namespace {

scenes::Scene strips(std::initializer_list<std::uint32_t> triangles) {
  scenes::Scene scene;
  for (const std::uint32_t count : triangles) {
    scenes::Mesh mesh;
    mesh.positions.resize(count + 2);
    for (std::uint32_t t = 0; t < count; ++t) mesh.triangles.emplace_back(t, t + 1, t + 2);
    scene.instances.push_back({static_cast<std::uint32_t>(scene.meshes.size()), {}});
    scene.meshes.push_back(mesh);
  }
  return scene;
}

TEST(Draws, PiecesCoverAnyRangeOfPrimitivesOnce) {
  scenes::Scene scene = strips({5, 0, 1, 3000});
  scene.instances.push_back({0, {}});
  const std::vector<std::uint64_t> first = scenes::first_primitives(scene);
  ASSERT_EQ(first.back(), 3011U);
  std::mt19937 random(1);
  for (int round = 0; round < 200; ++round) {
    const std::uint64_t begin = random() % 3012, end = begin + random() % (3012 - begin);
    std::uint64_t next = begin;
    for (const Piece& piece : pieces_of(scene, first, begin, end)) {
      EXPECT_EQ(piece.primitive, next);
      EXPECT_GT(piece.count, 0U);
      EXPECT_LE(piece.first + piece.count, piece.mesh->triangles.size());
      next += piece.count;
    }
    EXPECT_EQ(next, end);
  }
}

TEST(Draws, NumbersAscendAsPrimitivesDoAndLeadBackToThem) {
  const scenes::Scene scene = strips({700, 2500, 40});
  const std::vector<std::uint64_t> first = scenes::first_primitives(scene);
  std::mt19937 random(2);
  for (int round = 0; round < 50; ++round) {
    // Some of the primitives, in pieces of all lengths and in any order.
    std::vector<Piece> pieces;
    std::vector<std::pair<const scenes::Mesh*, std::uint32_t>> expected;
    for (std::uint64_t at = 0; at < first.back();) {
      const std::uint64_t end = std::min(at + 1 + random() % 900, first.back());
      if (random() % 3 != 0) {
        for (const Piece& piece : pieces_of(scene, first, at, end)) {
          pieces.push_back(piece);
          for (std::uint32_t i = 0; i < piece.count; ++i)
            expected.emplace_back(piece.mesh, piece.first + i);
        }
      }
      at = end;
    }
    std::shuffle(pieces.begin(), pieces.end(), random);
    SceneClusters known(scene.meshes);
    const DrawList list = make_draw_list(pieces, round % 2 == 0 ? &known : nullptr);
    EXPECT_EQ(list.triangles, expected.size());
    EXPECT_LE(list.draws.size(), 3U);
    std::size_t next = 0;
    for (std::uint32_t k = 0; k < list.clusters.size(); ++k) {
      ASSERT_LE(list.clusters[k].end, kClusterTriangles);
      const ClusterBlock& block = list.block_of(list.clusters[k]);
      const MeshCluster& mesh_cluster = block.clusters[list.clusters[k].part];
      ASSERT_LE(list.clusters[k].end, mesh_cluster.count);
      ASSERT_EQ(list.clusters[k].first, mesh_cluster.first);
      for (std::uint32_t i = list.clusters[k].begin; i < list.clusters[k].end; ++i, ++next) {
        const std::uint32_t number = (k << kClusterBits) | i;
        const Draw& draw = list.draws[list.cluster_of(number).draw];
        ASSERT_EQ(draw.mesh, expected[next].first);
        ASSERT_EQ(list.triangle_of(number), expected[next].second);
      }
    }
    EXPECT_EQ(next, expected.size());
  }
}

TEST(Draws, NothingGivesAnEmptyList) {
  const DrawList list = make_draw_list({});
  EXPECT_TRUE(list.draws.empty());
  EXPECT_TRUE(list.clusters.empty());
}

TEST(Draws, PrimitivesOfNumbersAscend) {
  const scenes::Scene scene = strips({700, 2500, 40});
  const std::vector<std::uint64_t> first = scenes::first_primitives(scene);
  const DrawList list = make_draw_list(pieces_of(scene, first, 150, 3100));
  std::mt19937 random(3);
  for (const int count : {0, 1, 7, 5000}) {
    std::vector<std::uint32_t> numbers;
    std::vector<std::uint64_t> expected;
    for (int i = 0; i < count; ++i) {
      const auto cluster = static_cast<std::uint32_t>(random() % list.clusters.size());
      const Cluster& at = list.clusters[cluster];
      const auto place = static_cast<std::uint32_t>(at.begin + random() % (at.end - at.begin));
      numbers.push_back((cluster << kClusterBits) | place);
      expected.push_back(list.primitive_of(numbers.back()));
    }
    std::ranges::sort(expected);
    EXPECT_EQ(primitives_of(list, numbers), expected);
  }
  EXPECT_TRUE(primitives_of(DrawList{}, {}).empty());
}

}  // namespace
}  // namespace delray::raster
