#include "raster/distribute/travel.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/raster/random_scene.h"

namespace delray::raster {
namespace {

template <class Value>
void expect_same(const std::vector<Value>& from, const std::vector<Value>& to, std::uint32_t i,
                 std::uint32_t j) {
  ASSERT_EQ(from.empty(), to.empty());
  if (!from.empty()) {
    EXPECT_EQ(from[i], to[j]);
  }
}

std::vector<std::byte> packed(std::span<const Piece> pieces, SceneClusters& clusters) {
  const GeometryPacker packer(pieces, clusters);
  std::vector<std::byte> message(packer.bytes());
  packer.write(message.data());
  return message;
}

// Pieces of few triangles, most of which begin and end within a cluster, some in two.
std::vector<Piece> some_pieces(const scenes::Scene& scene, std::uint32_t triangles) {
  const std::vector<std::uint64_t> first = scenes::first_primitives(scene);
  std::vector<Piece> pieces;
  for (const Piece& piece : pieces_of(scene, first, 7, first.back() - 5)) {
    for (std::uint32_t t = 0; t < piece.count; t += triangles) {
      pieces.push_back({piece.mesh, piece.transform, piece.first + t,
                        std::min(triangles, piece.count - t), piece.primitive + t});
    }
  }
  return pieces;
}

void expect_arrived(const Piece& sent, const Arrival& arrival) {
  const Piece& piece = arrival.piece;
  EXPECT_EQ(piece.primitive, sent.primitive);
  ASSERT_EQ(piece.count, sent.count);
  EXPECT_EQ(*piece.transform, *sent.transform);
  EXPECT_EQ(piece.mesh, &arrival.mesh->mesh);
  EXPECT_EQ(piece.mesh->material, sent.mesh->material);
  for (std::uint32_t t = 0; t < piece.count; ++t) {
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t from = sent.mesh->triangles[sent.first + t][c];
      const std::uint32_t to = piece.mesh->triangles[piece.first + t][c];
      expect_same(sent.mesh->positions, piece.mesh->positions, from, to);
      expect_same(sent.mesh->normals, piece.mesh->normals, from, to);
      expect_same(sent.mesh->uvs, piece.mesh->uvs, from, to);
      expect_same(sent.mesh->uvs2, piece.mesh->uvs2, from, to);
      expect_same(sent.mesh->tangents, piece.mesh->tangents, from, to);
      expect_same(sent.mesh->colours, piece.mesh->colours, from, to);
    }
  }
}

TEST(Travel, GeometryArrivesAsItLeft) {
  for (const std::uint32_t triangles : {1U, 59U, 128U, 1000U, 1U << 20}) {
    const scenes::Scene scene = with_second_uvs(random_scene(1));
    SceneClusters clusters(scene.meshes);
    const std::vector<Piece> sent = some_pieces(scene, triangles);
    ASSERT_GE(sent.size(), scene.instances.size());
    std::vector<Arrival> arrivals;
    unpack_geometry(packed(std::span(sent).first(3), clusters), arrivals);
    unpack_geometry(packed(std::span(sent).subspan(3), clusters), arrivals);
    ASSERT_EQ(arrivals.size(), sent.size());
    for (std::size_t k = 0; k < sent.size(); ++k) expect_arrived(sent[k], arrivals[k]);
  }
}

// What arrives is drawn as it is: its clusters must be as if it had been cut there.
TEST(Travel, ClustersArriveWithTheGeometry) {
  const scenes::Scene scene = random_scene(3);
  SceneClusters clusters(scene.meshes);
  const std::vector<Piece> sent = some_pieces(scene, 100);
  std::vector<Arrival> arrivals;
  unpack_geometry(packed(sent, clusters), arrivals);
  std::vector<Piece> pieces;
  for (const Arrival& arrival : arrivals) pieces.push_back(arrival.piece);
  const DrawList list = make_draw_list(pieces);
  EXPECT_TRUE(list.own.empty());
  std::uint64_t triangles = 0;
  for (std::size_t k = 0; k < list.clusters.size(); ++k) {
    const Cluster& cluster = list.clusters[k];
    const ClusterBlock& block = list.block_of(cluster);
    const MeshCluster& mesh_cluster = block.clusters[cluster.part];
    ASSERT_EQ(cluster.first, mesh_cluster.first);
    const scenes::Mesh& mesh = *list.draws[cluster.draw].mesh;
    const std::span<const std::uint32_t> vertices = block.vertices_of(mesh_cluster);
    for (std::uint32_t place = cluster.begin; place < cluster.end; ++place, ++triangles) {
      const std::uint8_t* const corner = block.corners.data() + mesh_cluster.first_corner + place;
      for (std::uint32_t c = 0; c < 3; ++c) {
        const std::uint32_t vertex = vertices[corner[c * mesh_cluster.corner_stride()]];
        EXPECT_EQ(vertex, mesh.triangles[cluster.first + place][static_cast<int>(c)]);
        EXPECT_TRUE(glm::all(glm::lessThanEqual(mesh_cluster.box.low, mesh.positions[vertex])));
        EXPECT_TRUE(glm::all(glm::lessThanEqual(mesh.positions[vertex], mesh_cluster.box.high)));
      }
    }
  }
  EXPECT_EQ(triangles, list.triangles);
  std::uint64_t all = 0;
  for (const Piece& piece : sent) all += piece.count;
  EXPECT_EQ(triangles, all);
  const std::uint32_t last = static_cast<std::uint32_t>(list.clusters.size() - 1) << kClusterBits;
  EXPECT_EQ(list.primitive_of(0), sent.front().primitive);
  EXPECT_EQ(list.primitive_of(last + list.clusters.back().end - 1),
            sent.back().primitive + sent.back().count - 1);
}

// So that few meshes are drawn, and a group that stays keeps little else.
TEST(Travel, GroupsOfAnInstanceShareMeshesOfBoundedSize) {
  const scenes::Scene scene = random_scene(4);
  SceneClusters clusters(scene.meshes);
  const std::vector<Piece> sent = some_pieces(scene, 10);
  std::vector<Arrival> arrivals;
  unpack_geometry(packed(sent, clusters), arrivals);
  std::set<const scenes::Mesh*> meshes;
  for (const Arrival& arrival : arrivals) {
    meshes.insert(arrival.piece.mesh);
    EXPECT_LE(arrival.piece.mesh->triangles.size(), GeometryPacker::kTravelledTriangles);
  }
  EXPECT_LE(meshes.size(), scene.instances.size() +
                               scenes::triangle_count(scene) / GeometryPacker::kTravelledTriangles);
}

TEST(Travel, NumbersLeadToTheScenesOwnMeshes) {
  const scenes::Scene scene = random_scene(2);
  const std::vector<std::uint64_t> first = scenes::first_primitives(scene);
  const std::vector<Piece> sent = pieces_of(scene, first, 3, first.back());
  const std::vector<std::uint64_t> numbers = pack_numbers(sent);
  std::vector<Arrival> arrivals;
  unpack_numbers(std::as_bytes(std::span(numbers)), scene, first, arrivals);
  ASSERT_EQ(arrivals.size(), sent.size());
  for (std::size_t k = 0; k < sent.size(); ++k) {
    const Piece& piece = arrivals[k].piece;
    EXPECT_EQ(piece.mesh, sent[k].mesh);
    EXPECT_EQ(piece.transform, sent[k].transform);
    EXPECT_EQ(piece.first, sent[k].first);
    EXPECT_EQ(piece.count, sent[k].count);
    EXPECT_EQ(piece.primitive, sent[k].primitive);
  }
}

TEST(Travel, NothingIsAnEmptyMessage) {
  const scenes::Scene scene = random_scene(5);
  SceneClusters clusters(scene.meshes);
  std::vector<Arrival> arrivals;
  unpack_geometry(packed({}, clusters), arrivals);
  EXPECT_TRUE(arrivals.empty());
}

}  // namespace
}  // namespace delray::raster
