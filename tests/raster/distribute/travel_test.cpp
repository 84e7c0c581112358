#include "raster/distribute/travel.h"

#include <gtest/gtest.h>

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

TEST(Travel, GeometryArrivesAsItLeft) {
  const scenes::Scene scene = with_second_uvs(random_scene(1));
  const std::vector<std::uint64_t> first = scenes::first_primitives(scene);
  const std::vector<Piece> sent = pieces_of(scene, first, 7, first.back() - 5);
  ASSERT_EQ(sent.size(), scene.instances.size());
  Arrivals arrivals;
  unpack_geometry(pack_geometry(std::span(sent).first(3)), arrivals);
  unpack_geometry(pack_geometry(std::span(sent).subspan(3)), arrivals);
  ASSERT_EQ(arrivals.pieces.size(), sent.size());
  for (std::size_t k = 0; k < sent.size(); ++k) {
    const Piece& piece = arrivals.pieces[k];
    EXPECT_EQ(piece.primitive, sent[k].primitive);
    EXPECT_EQ(piece.count, sent[k].count);
    EXPECT_EQ(*piece.transform, *sent[k].transform);
    EXPECT_EQ(piece.mesh->material, sent[k].mesh->material);
    for (std::uint32_t t = 0; t < piece.count; ++t) {
      for (int c = 0; c < 3; ++c) {
        const std::uint32_t from = sent[k].mesh->triangles[sent[k].first + t][c];
        const std::uint32_t to = piece.mesh->triangles[piece.first + t][c];
        expect_same(sent[k].mesh->positions, piece.mesh->positions, from, to);
        expect_same(sent[k].mesh->normals, piece.mesh->normals, from, to);
        expect_same(sent[k].mesh->uvs, piece.mesh->uvs, from, to);
        expect_same(sent[k].mesh->uvs2, piece.mesh->uvs2, from, to);
        expect_same(sent[k].mesh->tangents, piece.mesh->tangents, from, to);
        expect_same(sent[k].mesh->colours, piece.mesh->colours, from, to);
      }
    }
  }
}

TEST(Travel, NumbersLeadToTheScenesOwnMeshes) {
  const scenes::Scene scene = random_scene(2);
  const std::vector<std::uint64_t> first = scenes::first_primitives(scene);
  const std::vector<Piece> sent = pieces_of(scene, first, 3, first.back());
  Arrivals arrivals;
  unpack_numbers(pack_numbers(sent), scene, first, arrivals);
  ASSERT_EQ(arrivals.pieces.size(), sent.size());
  for (std::size_t k = 0; k < sent.size(); ++k) {
    EXPECT_EQ(arrivals.pieces[k].mesh, sent[k].mesh);
    EXPECT_EQ(arrivals.pieces[k].transform, sent[k].transform);
    EXPECT_EQ(arrivals.pieces[k].first, sent[k].first);
    EXPECT_EQ(arrivals.pieces[k].count, sent[k].count);
    EXPECT_EQ(arrivals.pieces[k].primitive, sent[k].primitive);
  }
}

TEST(Travel, NothingIsAnEmptyMessage) {
  Arrivals arrivals;
  unpack_geometry(pack_geometry({}), arrivals);
  EXPECT_TRUE(arrivals.pieces.empty());
}

}  // namespace
}  // namespace delray::raster
