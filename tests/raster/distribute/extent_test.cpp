#include "raster/distribute/extent.h"

#include <gtest/gtest.h>

#include <random>

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

TEST(Extent, ContainsEveryPixel) {
  const Screen screen = make_screen(plain_view(150, 90));
  const scenes::Mesh mesh = random_mesh(2);
  const PreparedMesh prepared(screen, mesh);
  const SetUpMesh set_up = set_up_mesh(screen, mesh);
  std::uint64_t with_pixels = 0;
  std::vector<ScreenTriangle> large;
  for (std::uint32_t t = 0; t < 400; ++t) {
    const Extent e = Extents(screen).of(prepared.draw, t, 1, large);
    EXPECT_EQ(e.triangles > 0, !e.box.empty());
    std::vector<int> pixels(150 * 90);
    for (const ScreenTriangle& triangle : set_up.triangles)
      if (prepared.list.triangle_of(triangle.number) == t) count(screen, triangle, pixels);
    for (int y = 0; y < 90; ++y) {
      for (int x = 0; x < 150; ++x) {
        if (pixels[y * 150 + x] != 0) {
          ASSERT_TRUE(e.box.contains(x, y));
          ++with_pixels;
        }
      }
    }
  }
  EXPECT_GT(with_pixels, 1000U);
}

TEST(Extent, OfARangeIsThatOfItsTriangles) {
  const Screen screen = make_screen(plain_view(150, 90));
  const scenes::Mesh mesh = random_mesh(3);
  const PreparedMesh prepared(screen, mesh);
  for (const auto& [first, count] : {std::pair{0U, 400U}, {70U, 200U}, {399U, 1U}, {5U, 0U}}) {
    Extent sum;
    std::vector<ScreenTriangle> large, large_of_range;
    for (std::uint32_t t = first; t < first + count; ++t) {
      const Extent e = Extents(screen).of(prepared.draw, t, 1, large);
      sum.triangles += e.triangles;
      sum.pixels += e.pixels;
      if (e.box.empty()) continue;
      sum.box =
          sum.box.empty()
              ? e.box
              : geometry::Rect{std::min(sum.box.x0, e.box.x0), std::min(sum.box.y0, e.box.y0),
                               std::max(sum.box.x1, e.box.x1), std::max(sum.box.y1, e.box.y1)};
    }
    const Extent whole = Extents(screen).of(prepared.draw, first, count, large_of_range);
    EXPECT_EQ(whole.box, sum.box);
    EXPECT_EQ(whole.triangles, sum.triangles);
    EXPECT_EQ(whole.pixels, sum.pixels);
    EXPECT_EQ(large_of_range.size(), large.size());
  }
}

// A plane of triangles smaller than pixels: of the clusters that a run has as a whole most are not
// looked at.
// The pixels that the box around some triangles reaches, and three more on each side.
geometry::Rect pixels_of_box(const Screen& screen, const scenes::Mesh& mesh, std::uint32_t first,
                             std::uint32_t count) {
  geometry::Box3 box;
  for (std::uint32_t t = first; t < first + count; ++t)
    for (int k = 0; k < 3; ++k) box.include(mesh.positions[mesh.triangles[t][k]]);
  const ToView map = to_view(screen.view, glm::mat4x3(1.0F));
  glm::vec2 low(1e9F), high(-1e9F);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 p =
        map({(corner & 1) != 0 ? box.high.x : box.low.x, (corner & 2) != 0 ? box.high.y : box.low.y,
             (corner & 4) != 0 ? box.high.z : box.low.z});
    const glm::vec2 on_screen(screen.view.half_width + p.x / p.z * screen.view.scale,
                              screen.view.half_height - p.y / p.z * screen.view.scale);
    low = glm::min(low, on_screen);
    high = glm::max(high, on_screen);
  }
  constexpr int kMargin = 3;
  return geometry::intersection(
      {static_cast<int>(low.x) - kMargin, static_cast<int>(low.y) - kMargin,
       static_cast<int>(high.x) + 1 + kMargin, static_cast<int>(high.y) + 1 + kMargin},
      screen.frame());
}

TEST(Extent, OfWholeSmallClustersIsNearlyThatOfTheirTriangles) {
  constexpr std::uint32_t kSide = 257;  // vertices
  scenes::Mesh mesh;
  for (std::uint32_t y = 0; y < kSide; ++y) {
    for (std::uint32_t x = 0; x < kSide; ++x)
      mesh.positions.emplace_back(0.006F * static_cast<float>(x) - 0.77F,
                                  0.006F * static_cast<float>(y) - 0.77F,
                                  -2 - 0.002F * static_cast<float>(x));
  }
  for (std::uint32_t y = 0; y + 1 < kSide; ++y) {
    for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
      const std::uint32_t i = y * kSide + x;
      mesh.triangles.emplace_back(i, i + 1, i + kSide);
      mesh.triangles.emplace_back(i + 1, i + kSide + 1, i + kSide);
    }
  }
  const Screen screen = make_screen(plain_view(200, 200));
  const PreparedMesh prepared(screen, mesh);
  std::vector<ScreenTriangle> large;
  Extent whole, exact;
  int estimated = 0;
  const auto include = [](const Extent& e, Extent& sum) {
    sum.triangles += e.triangles;
    sum.pixels += e.pixels;
  };
  constexpr std::uint32_t kRun = 2 * kClusterTriangles;
  const auto all = static_cast<std::uint32_t>(mesh.triangles.size());
  for (std::uint32_t first = 0; first < all; first += kRun) {
    const Extent run = Extents(screen).of(prepared.draw, first, kRun, large);
    Extent of_triangles;
    geometry::Rect box{200, 200, 0, 0};
    for (std::uint32_t t = first; t < first + kRun; ++t) {
      const Extent one = Extents(screen).of(prepared.draw, t, 1, large);
      include(one, of_triangles);
      if (one.triangles == 0) continue;
      box = {std::min(box.x0, one.box.x0), std::min(box.y0, one.box.y0),
             std::max(box.x1, one.box.x1), std::max(box.y1, one.box.y1)};
    }
    if (of_triangles.triangles == 0) continue;
    EXPECT_EQ(geometry::intersection(run.box, box), box) << first;
    const geometry::Rect reach = pixels_of_box(screen, mesh, first, kRun);
    EXPECT_EQ(geometry::intersection(run.box, reach), run.box) << first;
    estimated += run.triangles != of_triangles.triangles;
    include(run, whole);
    include(of_triangles, exact);
  }
  EXPECT_TRUE(large.empty());
  EXPECT_GT(estimated, 100);
  EXPECT_NEAR(static_cast<double>(whole.triangles), static_cast<double>(exact.triangles),
              0.08 * static_cast<double>(exact.triangles));
  EXPECT_NEAR(static_cast<double>(whole.pixels), static_cast<double>(exact.pixels),
              0.08 * static_cast<double>(exact.pixels));
}

}  // namespace
}  // namespace delray::raster
