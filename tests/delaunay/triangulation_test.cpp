// The hash of a triangulation.
#include "delaunay/triangulation.h"

#include <gtest/gtest.h>
#include <xxhash.h>

#include <array>
#include <cstdint>
#include <limits>

namespace delray::delaunay {
namespace {

TEST(Hash128, AddsWithCarry) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
  EXPECT_EQ((Hash128{1, kMost} + Hash128{2, 1}), (Hash128{4, 0}));
  EXPECT_EQ((Hash128{kMost, kMost} + Hash128{0, 1}), (Hash128{0, 0}));
  EXPECT_EQ((Hash128{3, 4} + Hash128{5, 6}), (Hash128{8, 10}));
}

TEST(Hash128, PrintsTheHighHalfFirst) {
  EXPECT_EQ(to_string(Hash128{0x0123456789abcdefU, 0xfU}), "0123456789abcdef000000000000000f");
}

template <std::size_t Corners>
Hash128 hash_of(const std::array<std::uint64_t, Corners>& ascending) {
  const XXH128_hash_t hash = XXH3_128bits(ascending.data(), sizeof ascending);
  return {hash.high64, hash.low64};
}

TEST(Hash, IsTheSumOverSimplicesOfTheirSortedRows) {
  Triangulation triangles;
  triangles.vertices = {7, 2, 5, 1, 300, 2};
  EXPECT_EQ(hash(triangles), hash_of<3>({2, 5, 7}) + hash_of<3>({1, 2, 300}));
  Triangulation tetrahedra;
  tetrahedra.dim = 3;
  tetrahedra.vertices = {7, 2, 5, 1, 9, 8, 4, 3};
  EXPECT_EQ(hash(tetrahedra), hash_of<4>({1, 2, 5, 7}) + hash_of<4>({3, 4, 8, 9}));
  EXPECT_EQ(hash(Triangulation{}), Hash128{});
}

TEST(Hash, DependsOnNeitherOrderNorBlocks) {
  Triangulation forward, backward;
  constexpr std::uint32_t kSimplices = 20000;
  Hash128 sum;
  for (std::uint32_t i = 0; i < kSimplices; ++i) {
    forward.vertices.insert(forward.vertices.end(), {i, i + 1, i + 2});
    const std::uint32_t j = kSimplices - 1 - i;
    backward.vertices.insert(backward.vertices.end(), {j + 2, j, j + 1});
    sum = sum + hash_of<3>({i, i + 1, i + 2});
  }
  EXPECT_EQ(hash(forward), sum);
  EXPECT_EQ(hash(backward), sum);
}

}  // namespace
}  // namespace delray::delaunay
