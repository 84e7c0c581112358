// Spots that are set up by vectors, against their definition.
#include "raster/pipeline/splat_set_up.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "raster/pipeline/transform.h"
#include "tests/raster/coverage.h"
#include "tests/support/targets.h"

namespace delray::raster {
namespace {

constexpr int kSpotsWidth = 150, kSpotsHeight = 133;  // three by three tiles

scenes::Mesh random_points(std::mt19937& random, std::size_t count, float radius) {
  std::uniform_real_distribution<float> place(-1.2F, 1.2F);
  scenes::Mesh mesh;
  mesh.shape = {scenes::Shape::Kind::point, true, radius};
  for (std::uint32_t i = 0; i < count; ++i) {
    mesh.positions.emplace_back(place(random), place(random),
                                i % 7 == 0 ? -2.0F : -2.0F + 0.5F * place(random));
    mesh.triangles.emplace_back(i);
  }
  return mesh;
}

// By pixel of the screen: the least key of what a cluster's spots were set up as.
std::vector<std::int64_t> keys_of(const Screen& screen, const SetUpResult& result) {
  std::vector<std::int64_t> keys(std::size_t{kSpotsWidth} * kSpotsHeight);
  const auto tile = std::make_unique<VisibilityTile>();
  for (int k = 0; k < screen.tiles(); ++k) {
    const geometry::Rect rect = screen.tile(k);
    tile->clear(rect);
    std::vector<std::uint32_t> spots, entries;
    std::vector<Fragment> fragments;
    for (std::uint32_t i = 0; i < result.spots.size; ++i)
      if (result.spots.tile[i] == static_cast<std::uint32_t>(k)) spots.push_back(i);
    for (std::size_t i = 0; i < result.fragments; ++i) {
      if (result.address[i] / kTilePixels != static_cast<std::uint32_t>(k)) continue;
      fragments.push_back(
          {static_cast<std::int64_t>(std::uint64_t{result.code[i]} << 32 | result.number[i]),
           result.address[i] % kTilePixels});
    }
    for (const SetUpResult::Entry& entry : result.splat_entries)
      if (entry.tile == static_cast<std::uint32_t>(k)) entries.push_back(entry.entry);
    rasterize_spots(result.spots, spots, *tile);
    rasterize_fragments(fragments, *tile);
    rasterize_splats(screen, rect, result.splats, entries, *tile);
    for (int y = rect.y0; y < rect.y1; ++y) {
      for (int x = rect.x0; x < rect.x1; ++x)
        keys[y * kSpotsWidth + x] = tile->key[(y - rect.y0) * kTileSize + x - rect.x0];
    }
  }
  return keys;
}

std::vector<std::int64_t> by_definition(const Screen& screen, const SplatDraw& splats,
                                        const scenes::Mesh& mesh, const geometry::Rect& clip) {
  std::vector<std::int64_t> keys(std::size_t{kSpotsWidth} * kSpotsHeight, kEmptyKey);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Splat splat = make_splat(screen, splats, mesh, t, t);
    const geometry::Rect pixels = geometry::intersection(splat.pixels, clip);
    for (int y = pixels.y0; y < pixels.y1; ++y) {
      for (int x = pixels.x0; x < pixels.x1; ++x) {
        float depth = 0;
        if (!covers(screen, splat, x, y, depth)) continue;
        std::int64_t& key = keys[y * kSpotsWidth + x];
        key = std::min(key, key_of(depth, t));
      }
    }
  }
  return keys;
}

TEST(SplatSetUp, SpotsCoverTheirPixelsOnEveryTarget) {
  const unsigned seed = 5;
  std::mt19937 random(seed);
  const Screen screen = make_screen(plain_view(kSpotsWidth, kSpotsHeight));
  // One pixel, windows of 3, 5 and 7 rows, squares too large for them, and splats one by one.
  for (const float radius : {0.3F, 0.9F, 1.4F, 2.2F, 3.4F, 3.9F, 6.0F}) {
    const scenes::Mesh mesh = random_points(random, 100, radius);
    MeshClusters clusters;
    clusters.make(mesh, 0, 100);
    const ClusterBlock& block = *clusters.blocks.front();
    ASSERT_EQ(block.clusters.size(), 1U);
    const glm::mat4x3 in_place(1.0F);
    const Draw draw{&mesh, &in_place, &clusters};
    PreparedDraw prepared;
    prepared.draw = &draw;
    prepared.to_view = to_view(screen.view, in_place);
    prepared.splats = make_splat_draw(screen, draw);
    for (const geometry::Rect& clip :
         {geometry::Rect{0, 0, kSpotsWidth, kSpotsHeight}, geometry::Rect{13, 40, 130, 97}}) {
      const std::vector<std::int64_t> expected = by_definition(screen, prepared.splats, mesh, clip);
      tests::for_each_target([&] {
        for (const bool fragments_only : {false, true}) {
          SetUpResult result;
          result.fragments_only = fragments_only;
          ScreenVertices vertices;
          const ClusterToSetUp cluster{
              {screen, prepared, block, block.clusters[0], vertices}, 0, 100, 0, clip};
          set_up_splats(cluster, vertices, result);
          EXPECT_EQ(result.spots.size > 0, !fragments_only && radius > 0.5F && radius < 3.5F);
          EXPECT_TRUE(keys_of(screen, result) == expected)
              << "seed " << seed << ", radius " << radius;
          EXPECT_EQ(result.counts.in, 100U);
        }
      });
    }
  }
}

}  // namespace
}  // namespace delray::raster
