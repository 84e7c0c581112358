#include "raster/shading/pixel_triangles.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "tests/raster/coverage.h"
#include "tests/support/targets.h"

namespace delray::raster {
namespace {

// Vertices of random sizes of triangle, from specks to some beyond the frame; some are outside.
void make_vertices(std::mt19937& random, ScreenVertices& vertices) {
  const int reach = 1 << (2 + random() % 16);
  const auto near = [&] { return static_cast<int>(random() % (2U * reach + 1U)) - reach; };
  const int x = static_cast<int>(random() % 80000) - 40000;
  const int y = static_cast<int>(random() % 50000) - 25000;
  for (std::size_t i = 0; i < kClusterVertices; ++i) {
    vertices.x[i] = random() % 50 == 0 ? kOutside : x + near();
    vertices.y[i] = y + near();
    vertices.depth[i] = -1.0F / static_cast<float>(1 + random() % 50);
  }
}

TEST(PixelTriangles, PlanesAreThoseOfTrianglesAlone) {
  const Screen screen = make_screen(plain_view(320, 200));
  const auto planes = std::make_unique<TrianglePlanes>();
  const auto vertices = std::make_unique<ScreenVertices>();
  std::size_t proper = 0, improper = 0, outside = 0;
  tests::for_each_target([&] {
    std::mt19937 random(3);
    for (int round = 0; round < 60; ++round) {
      make_vertices(random, *vertices);
      CornerNumbers corners;
      const std::size_t count = 1 + random() % kClusterTriangles, first = random() % 100;
      const std::size_t used = 3 + random() % (kClusterVertices - 2);
      for (auto& row : corners.of)
        for (std::size_t i = 0; i < count; ++i) row[i] = static_cast<std::uint8_t>(random() % used);
      corners.pad(count);
      ClusterFacing facing;
      set_up_planes(screen, *vertices, used, corners, count, 1000, *planes, first, facing);
      for (std::size_t i = 0; i < count; ++i) {
        std::array<ScreenVertex, 3> v;
        bool any_outside = false;
        for (int k = 0; k < 3; ++k) {
          v[k] = (*vertices)[corners.of[k][i]];
          any_outside |= v[k].x == kOutside;
          ASSERT_EQ(planes->corner[k][first + i], 1000U + corners.of[k][i]);
        }
        ASSERT_EQ(is_in(facing.outside, i), any_outside);
        outside += any_outside;
        if (any_outside) continue;
        const Barycentrics expected = make_barycentrics(screen, v);
        ASSERT_EQ(is_in(facing.counter_clockwise, i), expected.counter_clockwise);
        ASSERT_EQ(is_in(facing.proper, i), expected.proper);
        (expected.proper ? proper : improper) += 1;
        for (int k = 0; k < 3; ++k) {
          ASSERT_EQ(planes->a[k][first + i], expected.a[k]);
          ASSERT_EQ(planes->b[k][first + i], expected.b[k]);
          ASSERT_EQ(planes->c[k][first + i], expected.c[k]);
        }
        ASSERT_EQ(planes->x[first + i], static_cast<float>(expected.x));
        ASSERT_EQ(planes->y[first + i], static_cast<float>(expected.y));
      }
    }
  });
  EXPECT_GT(proper, 5000U);
  EXPECT_GT(improper, 50U);
  EXPECT_GT(outside, 500U);
}

TEST(PixelTriangles, ColoursAreThoseOfTrianglesAlone) {
  const auto planes = std::make_unique<TrianglePlanes>();
  std::vector<glm::vec4> radiances(50);
  std::vector<PixelTriangle> triangles(112);
  tests::for_each_target([&] {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> value(-3, 3);
    for (glm::vec4& radiance : radiances)
      radiance = {value(random), value(random), value(random), 1};
    std::vector<Barycentrics> barycentrics(100);
    std::vector<glm::uvec3> corners(112);
    for (std::size_t i = 0; i < barycentrics.size(); ++i) {
      Barycentrics& t = barycentrics[i];
      for (int k = 0; k < 3; ++k) {
        t.a[k] = value(random), t.b[k] = value(random), t.c[k] = value(random);
        corners[i][k] = static_cast<std::uint32_t>(random() % radiances.size());
      }
      t.x = static_cast<int>(i), t.y = static_cast<int>(2 * i);
      planes->set(i, t);
    }
    for (std::size_t i = 0; i < corners.size(); ++i)
      for (int k = 0; k < 3; ++k) planes->corner[k][i] = corners[i][k];
    set_up_colours(*planes, radiances, barycentrics.size(), triangles.data());
    for (std::size_t i = 0; i < barycentrics.size(); ++i) {
      glm::vec4 colours[3];
      for (int k = 0; k < 3; ++k) colours[k] = radiances[corners[i][k]];
      const ValuePlanes expected = make_value_planes(barycentrics[i], colours);
      for (int k = 0; k < 4; ++k) {
        ASSERT_EQ(triangles[i].a[k], expected.a[k]);
        ASSERT_EQ(triangles[i].b[k], expected.b[k]);
        ASSERT_EQ(triangles[i].c[k], expected.c[k]);
      }
      ASSERT_EQ(triangles[i].x, static_cast<float>(barycentrics[i].x));
      ASSERT_EQ(triangles[i].y, static_cast<float>(barycentrics[i].y));
    }
  });
}

}  // namespace
}  // namespace delray::raster
