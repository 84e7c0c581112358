#include "raster/internal/bins.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "tests/raster/coverage.h"

namespace delray::raster {
namespace {

scenes::Mesh random_mesh(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> both(-1, 1);
  scenes::Mesh mesh;
  for (int i = 0; i < 400; ++i) {
    const glm::vec3 centre(1.5F * both(random), 1.2F * both(random), -2);
    const float size = i % 20 == 0 ? 1.0F : 0.05F;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int k = 0; k < 3; ++k)
      mesh.positions.push_back(centre + size * glm::vec3(both(random), both(random), both(random)));
    mesh.triangles.emplace_back(first, first + 1, first + 2);
  }
  return mesh;
}

TEST(Bins, EveryTriangleIsInEveryWantedTileThatItTouches) {
  const Screen screen = make_screen(plain_view(300, 200));
  const scenes::Mesh mesh = random_mesh(1);
  const glm::mat4x3 identity(1.0F);
  const DrawList list = make_draw_list({{&mesh, &identity, 0, 400, 0}});
  std::vector<ScreenVertex> vertices(mesh.positions.size());
  PreparedDraw draw;
  draw.draw = &list.draws[0];
  draw.to_view = to_view(screen.view, identity);
  transform(draw.to_view, screen, mesh.positions, vertices);
  draw.vertices = vertices.data();
  std::vector<std::uint8_t> wanted(screen.tiles());
  for (std::size_t i = 0; i < wanted.size(); ++i) wanted[i] = i % 3 != 1;
  Bin bin;
  for (int round = 0; round < 2; ++round)  // the second reuses the memory of the first
    fill_bin(screen, list, {&draw, 1}, 0, 1, wanted, bin);

  EXPECT_EQ(bin.counts.in, 400U);
  EXPECT_GT(bin.counts.culled, 0U);
  EXPECT_EQ(bin.counts.rasterized, bin.triangles.size());
  std::set<std::uint32_t> seen;
  for (int tile = 0; tile < screen.tiles(); ++tile) {
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < bin.triangles.size(); ++i) {
      const ScreenVertex* v = bin.triangles[i].vertex;
      if (wanted[tile] &&
          !geometry::intersection(centres_in_box(v[0], v[1], v[2], screen), screen.tile(tile))
               .empty())
        expected.push_back(i);
    }
    const std::span<const std::uint32_t> entries = bin.of_tile(tile);
    EXPECT_EQ(std::vector<std::uint32_t>(entries.begin(), entries.end()), expected);
    seen.insert(entries.begin(), entries.end());
  }
  EXPECT_EQ(seen.size(), bin.triangles.size());
}

TEST(Bins, ExtentsContainEveryPixel) {
  const Screen screen = make_screen(plain_view(150, 90));
  const scenes::Mesh mesh = random_mesh(2);
  const glm::mat4x3 identity(1.0F);
  const DrawList list = make_draw_list({{&mesh, &identity, 0, 400, 0}});
  std::vector<ScreenVertex> vertices(mesh.positions.size());
  PreparedDraw draw;
  draw.draw = &list.draws[0];
  draw.to_view = to_view(screen.view, identity);
  transform(draw.to_view, screen, mesh.positions, vertices);
  draw.vertices = vertices.data();
  const SetUpMesh set_up = set_up_mesh(screen, mesh);
  std::uint64_t with_pixels = 0;
  for (std::uint32_t t = 0; t < 400; ++t) {
    const Extent e = extent(screen, draw, t, 1);
    EXPECT_EQ(e.triangles > 0, !e.box.empty());
    std::vector<int> pixels(150 * 90);
    for (const ScreenTriangle& triangle : set_up.triangles)
      if (triangle.number == t) count(screen, triangle, pixels);
    for (int y = 0; y < 90; ++y)
      for (int x = 0; x < 150; ++x)
        if (pixels[y * 150 + x] != 0) {
          ASSERT_TRUE(e.box.contains(x, y));
          ++with_pixels;
        }
  }
  EXPECT_GT(with_pixels, 1000U);
}

}  // namespace
}  // namespace delray::raster
