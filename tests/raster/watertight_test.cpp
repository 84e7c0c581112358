// Triangles that share an edge leave no hole and draw no pixel twice.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "raster/pipeline/set_up.h"
#include "tests/raster/coverage.h"
#include "tests/support/targets.h"

namespace delray::raster {
namespace {

struct Mesh2 {
  std::vector<glm::ivec2> points;  // subpixels from the centre pixel
  std::vector<glm::uvec3> triangles;
};

std::int64_t area(const Mesh2& mesh, glm::uvec3 t) {
  const glm::ivec2 a = mesh.points[t.x], b = mesh.points[t.y], c = mesh.points[t.z];
  return std::int64_t{b.x - a.x} * (c.y - a.y) - std::int64_t{c.x - a.x} * (b.y - a.y);
}

// A square of `reach` subpixels around the centre, cut by random points into triangles that cover
// it exactly once. Nothing is done for their shape, so most are slivers.
Mesh2 random_triangulation(std::mt19937& random, int reach, int step, int points) {
  Mesh2 mesh;
  mesh.points = {{-reach, -reach}, {reach, -reach}, {reach, reach}, {-reach, reach}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  std::uniform_int_distribution<int> place(-reach / step, reach / step);
  for (int i = 0; i < points; ++i) {
    const glm::ivec2 p{place(random) * step + (step > 1 ? kHalfPixel : 0),
                       place(random) * step + (step > 1 ? kHalfPixel : 0)};
    const auto number = static_cast<std::uint32_t>(mesh.points.size());
    mesh.points.push_back(p);
    std::vector<glm::uvec3> next;
    for (const glm::uvec3& t : mesh.triangles) {
      const glm::uvec3 parts[3] = {{number, t.y, t.z}, {t.x, number, t.z}, {t.x, t.y, number}};
      const bool inside = std::all_of(std::begin(parts), std::end(parts),
                                      [&](const auto& part) { return area(mesh, part) >= 0; });
      const bool corner = p == mesh.points[t.x] || p == mesh.points[t.y] || p == mesh.points[t.z];
      if (!inside || corner) {
        next.push_back(t);
        continue;
      }
      // On an edge one part is flat, in this triangle and in the one beyond the edge.
      for (const glm::uvec3& part : parts)
        if (area(mesh, part) > 0) next.push_back(part);
    }
    mesh.triangles = next;
  }
  return mesh;
}

// The mesh at random depths in front of the camera of plain_view.
scenes::Mesh placed(const Mesh2& mesh, const Screen& screen, std::mt19937& random) {
  std::uniform_real_distribution<double> depth(0.5, 50.0);
  scenes::Mesh result;
  for (const glm::ivec2& p : mesh.points) {
    const double z = depth(random);
    const double x = (p.x - double{screen.offset_x}) / kSubpixels / screen.view.scale * z;
    const double y = (double{screen.offset_y} - p.y) / kSubpixels / screen.view.scale * z;
    result.positions.emplace_back(x, y, -z);
  }
  result.triangles = mesh.triangles;
  return result;
}

void expect_each_pixel_once(int reach, int step, int points, unsigned seed) {
  const Screen screen = make_screen(plain_view(83, 71));
  std::mt19937 random(seed);
  const Mesh2 mesh = random_triangulation(random, reach, step, points);
  const SetUpMesh set_up = set_up_mesh(screen, placed(mesh, screen, random));
  EXPECT_EQ(set_up.counts.in, mesh.triangles.size());
  EXPECT_EQ(set_up.counts.clipped, 0U);
  EXPECT_EQ(set_up.counts.culled + set_up.counts.rasterized, set_up.counts.in);
  std::vector<int> pixels(83 * 71);
  for (const ScreenTriangle& t : set_up.triangles) count(screen, t, pixels);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    ASSERT_EQ(pixels[i], 1) << "seed " << seed << " pixel " << i % 83 << ", " << i / 83;
}

TEST(Watertight, RandomTriangulationsCoverEachPixelOnce) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    expect_each_pixel_once(60 * kSubpixels, 1, 60, seed);
    expect_each_pixel_once(50 * kSubpixels, 10 * kHalfPixel, 40, 100 + seed);
    expect_each_pixel_once(48 * kSubpixels, kSubpixels, 60, 200 + seed);
  }
}

TEST(Watertight, EveryTargetCoversEachPixelOnce) {
  tests::for_each_target([] { expect_each_pixel_once(50 * kSubpixels, kHalfPixel, 60, 300); });
}

// A plane through the camera's feet, cut into triangles that pass below and behind it and as far as
// `extent`; pixels well below the horizon are covered once, those above it never.
void expect_ground_once(float extent, unsigned seed) {
  const Screen screen = make_screen(plain_view(90, 66));
  std::mt19937 random(seed);
  const int reach = 1 << 20;
  const Mesh2 flat = random_triangulation(random, reach, 1, 40);
  scenes::Mesh mesh;
  for (const glm::ivec2& p : flat.points) {
    mesh.positions.emplace_back(static_cast<float>(p.x) / reach * extent, -1.0F,
                                static_cast<float>(p.y) / reach * extent);
  }
  mesh.triangles = flat.triangles;
  const SetUpMesh set_up = set_up_mesh(screen, mesh);
  EXPECT_GT(set_up.counts.clipped, 0U) << "seed " << seed;
  std::vector<int> pixels(90 * 66);
  for (const ScreenTriangle& t : set_up.triangles) count(screen, t, pixels);
  for (int y = 0; y < 66; ++y) {
    for (int x = 0; x < 90; ++x) {
      const glm::vec3 ray =
          screen.view.ray(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
      const glm::vec3 hit = ray * (-1.0F / ray.y);
      const bool within = ray.y < 0 && std::max(std::abs(hit.x), std::abs(hit.z)) < 0.9F * extent;
      const int n = pixels[y * 90 + x];
      if (within) {
        ASSERT_EQ(n, 1) << "seed " << seed << " extent " << extent << " pixel " << x << ", " << y;
      } else if (ray.y > 0) {
        ASSERT_EQ(n, 0) << "seed " << seed << " extent " << extent << " pixel " << x << ", " << y;
      } else {
        ASSERT_LE(n, 1);
      }
    }
  }
}

TEST(Watertight, GroundThroughTheNearPlaneIsCoveredOnce) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    expect_ground_once(20.0F, seed);
    expect_ground_once(1e4F, seed);
    expect_ground_once(1e9F, seed);
  }
}

TEST(Watertight, WildTrianglesAreHarmless) {
  const Screen screen = make_screen(plain_view(40, 30));
  std::mt19937 random(9);
  const float values[] = {0.0F,
                          -0.0F,
                          1.0F,
                          -1.0F,
                          1e-40F,
                          1e30F,
                          -1e30F,
                          3.4e38F,
                          1e-3F,
                          -0.01F,
                          0.01F,
                          std::numeric_limits<float>::infinity(),
                          -std::numeric_limits<float>::infinity(),
                          std::nanf("")};
  scenes::Mesh mesh;
  for (int i = 0; i < 3000; ++i) {
    mesh.positions.emplace_back(values[random() % std::size(values)],
                                values[random() % std::size(values)],
                                values[random() % std::size(values)]);
  }
  std::uint32_t n = static_cast<std::uint32_t>(mesh.positions.size());
  for (int i = 0; i < 20000; ++i)
    mesh.triangles.emplace_back(random() % n, random() % n, random() % n);
  const SetUpMesh set_up = set_up_mesh(screen, mesh);
  EXPECT_EQ(set_up.counts.culled + set_up.counts.rasterized, set_up.counts.in);
  EXPECT_GT(set_up.counts.rasterized, 0U);
  std::vector<int> pixels(40 * 30);
  for (const ScreenTriangle& t : set_up.triangles) {
    EXPECT_GT(doubled_area(t.vertex[0], t.vertex[1], t.vertex[2]), 0);
    for (const ScreenVertex& v : t.vertex) {
      EXPECT_LE(std::abs(v.x), kGuardSubpixels);
      EXPECT_LE(std::abs(v.y), kGuardSubpixels);
      EXPECT_GE(v.depth, -1.0F);
      EXPECT_LT(v.depth, 0.0F);
    }
    count(screen, t, pixels);
  }
}

TEST(Watertight, NothingBehindTheCameraIsDrawn) {
  const Screen screen = make_screen(plain_view(40, 30));
  scenes::Mesh mesh;
  mesh.positions = {{-1, -1, 1}, {1, -1, 1}, {0, 1, 1}, {0, 0, 0}, {0, 0, 0.5F}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {2, 3, 4}, {3, 3, 3}};
  const SetUpMesh set_up = set_up_mesh(screen, mesh);
  EXPECT_TRUE(set_up.triangles.empty());
  EXPECT_EQ(set_up.counts.culled, 4U);
}

}  // namespace
}  // namespace delray::raster
