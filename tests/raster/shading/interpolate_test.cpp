#include "raster/shading/interpolate.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/raster/coverage.h"

namespace delray::raster {
namespace {

// Intersects the pixel's ray with the triangle's plane in double (Cramer's rule).
bool exact_weights(const scenes::View& view, const std::array<glm::vec3, 3>& v, int x, int y,
                   double (&w)[3]) {
  const glm::dvec3 ray((x + 0.5 - view.half_width) / view.scale,
                       (view.half_height - (y + 0.5)) / view.scale, 1);
  const glm::dvec3 a(v[0]), b(v[1]), c(v[2]);
  const glm::dmat3 m(a, b, c);
  if (std::abs(glm::determinant(m)) < 1e-9) return false;
  const glm::dvec3 u = glm::inverse(m) * ray;
  const double sum = u.x + u.y + u.z;
  if (sum <= 0) return false;
  for (int k = 0; k < 3; ++k) w[k] = u[k] / sum;
  return w[0] >= 0 && w[1] >= 0 && w[2] >= 0;
}

TEST(Interpolate, IsPerspectiveCorrectAlsoAcrossTheNearPlane) {
  const Screen screen = make_screen(plain_view(320, 200));
  std::mt19937 random(1);
  std::uniform_real_distribution<float> side(-4, 4), depth(-3, 12);
  int checked = 0, crossing = 0;
  for (int round = 0; round < 400; ++round) {
    std::array<glm::vec3, 3> v;
    for (glm::vec3& p : v) p = {side(random), side(random), depth(random)};
    const Barycentrics t = make_barycentrics(screen, v);
    const bool crosses = v[0].z < 0 || v[1].z < 0 || v[2].z < 0;
    for (int i = 0; i < 100; ++i) {
      const int x = static_cast<int>(random() % 320), y = static_cast<int>(random() % 200);
      double exact[3];
      if (!exact_weights(screen.view, v, x, y, exact)) continue;
      const Weights w = weights_at(t, x, y);
      // The planes are rounded to floats of the size of their largest coefficient, so precision is
      // lost where their sum is small: near the line where the triangle's plane meets the eye's.
      const double scale = 1e-4 / w.sum + 1e-5;
      for (int k = 0; k < 3; ++k) ASSERT_NEAR(w.of[k], exact[k], scale) << "round " << round;
      ++checked;
      crossing += crosses;
    }
  }
  EXPECT_GT(checked, 2000);
  EXPECT_GT(crossing, 500);
}

TEST(Interpolate, DerivativesMatchDifferences) {
  const Screen screen = make_screen(plain_view(320, 200));
  const std::array<glm::vec3, 3> v{glm::vec3(-2, -1, 3), glm::vec3(2, -1, 4), glm::vec3(0, 2, 9)};
  const glm::vec2 uv[3] = {{0, 0}, {1, 0}, {0, 1}};
  const Barycentrics t = make_barycentrics(screen, v);
  const auto uv_at = [&](int x, int y) { return interpolate(weights_at(t, x, y), uv); };
  for (int y = 90; y < 110; y += 5) {
    for (int x = 150; x < 170; x += 5) {
      const Weights w = weights_at(t, x, y);
      const glm::vec2 dx = derivative(w, t.a, uv, uv_at(x, y));
      const glm::vec2 dy = derivative(w, t.b, uv, uv_at(x, y));
      const glm::vec2 difference_x = (uv_at(x + 1, y) - uv_at(x - 1, y)) * 0.5F;
      const glm::vec2 difference_y = (uv_at(x, y + 1) - uv_at(x, y - 1)) * 0.5F;
      for (int k = 0; k < 2; ++k) {
        EXPECT_NEAR(dx[k], difference_x[k], 2e-5F);
        EXPECT_NEAR(dy[k], difference_y[k], 2e-5F);
      }
    }
  }
}

TEST(Interpolate, ScreenPlanesHoldEveryPixelThatIsCovered) {
  const Screen screen = make_screen(plain_view(320, 200));
  std::mt19937 random(2);
  int checked = 0;
  for (int round = 0; round < 3000; ++round) {
    // From slivers to triangles larger than the frame.
    const int reach = 1 << (random() % 18);
    const int x = static_cast<int>(random() % 80000) - 40000;
    const int y = static_cast<int>(random() % 50000) - 25000;
    const auto near = [&](int centre) {
      return centre + static_cast<int>(random() % (2U * static_cast<unsigned>(reach))) - reach;
    };
    std::array<ScreenVertex, 3> v;
    for (ScreenVertex& p : v) p = {near(x), near(y), -1.0F / static_cast<float>(1 + random() % 50)};
    const std::int64_t area = doubled_area(v[0], v[1], v[2]);
    if (area == 0) continue;
    const Barycentrics t = make_barycentrics(screen, v);
    EXPECT_EQ(t.counter_clockwise, area < 0);
    ScreenTriangle triangle{{v[0], v[1], v[2]}, 0};
    if (area < 0) std::swap(triangle.vertex[1], triangle.vertex[2]);
    const geometry::Rect box = centres_in_box(v[0], v[1], v[2], screen);
    for (int i = 0; i < 60 && !box.empty(); ++i) {
      const int px = box.x0 + static_cast<int>(random() % static_cast<unsigned>(box.width()));
      const int py = box.y0 + static_cast<int>(random() % static_cast<unsigned>(box.height()));
      if (!covered_by_definition(triangle, screen, px, py)) continue;
      const double cx = (px - screen.centre_x) * kSubpixels + kHalfPixel;
      const double cy = (py - screen.centre_y) * kSubpixels + kHalfPixel;
      double exact[3], sum = 0, largest = 0;
      for (int k = 0; k < 3; ++k) {
        const ScreenVertex &p = v[(k + 1) % 3], &q = v[(k + 2) % 3];
        const double edge = (q.x - p.x) * (cy - p.y) - (q.y - p.y) * (cx - p.x);
        exact[k] = edge * v[k].depth * (area < 0 ? 1 : -1);
        ASSERT_GE(exact[k], 0);
        sum += exact[k];
        const double terms = std::abs((q.x - p.x) * (cy - t.y)) + std::abs((q.y - p.y) * cx);
        largest = std::max(largest,
                           std::abs(double{v[k].depth}) * (terms + double{kSubpixels} * kSubpixels +
                                                           std::abs(double(t.c[k] / v[k].depth))));
      }
      const Weights w = weights_at(t, px, py);
      // Planes are rounded; the sum of a sliver is small beside their terms.
      const double tolerance = 1e-6 + 1e-6 * largest / sum;
      for (int k = 0; k < 3; ++k) ASSERT_NEAR(w.of[k], exact[k] / sum, tolerance) << round;
      ++checked;
    }
  }
  EXPECT_GT(checked, 5000);
}

TEST(Interpolate, DegenerateTrianglesGiveFiniteWeights) {
  const Screen screen = make_screen(plain_view(320, 200));
  const std::array<glm::vec3, 3> cases[] = {
      {glm::vec3(0, 0, 1), glm::vec3(0, 0, 1), glm::vec3(0, 0, 1)},
      {glm::vec3(0, 0, 0), glm::vec3(0, 0, 0), glm::vec3(0, 0, 0)},
      {glm::vec3(0, 0, 1), glm::vec3(0, 0, 2), glm::vec3(0, 0, 3)},
      {glm::vec3(-1, 0, 1), glm::vec3(1, 0, 1), glm::vec3(0, 0, 5)},
      {glm::vec3(3e38F, 3e38F, 3e38F), glm::vec3(-3e38F, 0, 1), glm::vec3(0, 3e38F, -3e38F)},
      {glm::vec3(1e-40F, 0, 1e-40F), glm::vec3(0, 1e-40F, 1e-40F), glm::vec3(0, 0, 1e-40F)}};
  for (const auto& v : cases) {
    const Barycentrics t = make_barycentrics(screen, v);
    for (const int x : {0, 160, 319}) {
      for (const int y : {0, 100, 199}) {
        const Weights w = weights_at(t, x, y);
        float sum = 0;
        for (const float share : w.of) {
          EXPECT_GE(share, 0.0F);
          EXPECT_LE(share, 1.0F);
          sum += share;
        }
        EXPECT_NEAR(sum, 1.0F, 1e-5F);
      }
    }
  }
}

TEST(Interpolate, ProperPlanesGiveTheColoursOfBoundedShares) {
  const Screen screen = make_screen(plain_view(320, 200));
  std::mt19937 random(7);
  std::uniform_real_distribution<float> side(-4, 4), depth(-3, 12), unit(0, 1);
  int checked = 0, improper = 0;
  for (int round = 0; round < 3000; ++round) {
    // Every other one flat, some slivers.
    std::array<glm::vec3, 3> v;
    for (glm::vec3& p : v) p = {side(random), side(random), depth(random)};
    if (round % 5 == 0) v[2] = (v[0] + v[1]) * 0.5F + glm::vec3(0, unit(random) * 1e-5F, 0);
    const Barycentrics t = make_barycentrics(screen, v);
    improper += !t.proper;
    if (!t.proper) continue;
    glm::vec3 colours[3];
    for (glm::vec3& colour : colours) colour = {unit(random), unit(random), unit(random)};
    const ValuePlanes planes =
        make_value_planes(t, {{colours[0], 1}, {colours[1], 1}, {colours[2], 1}});
    for (int i = 0; i < 40; ++i) {
      const int x = static_cast<int>(random() % 320), y = static_cast<int>(random() % 200);
      double exact[3];
      if (!exact_weights(screen.view, v, x, y, exact)) continue;
      const glm::vec3 bounded = interpolate(weights_at(t, x, y), colours);
      const glm::vec4 sums =
          sums_at(planes, static_cast<float>(x - t.x), static_cast<float>(y - t.y));
      const glm::vec3 value = glm::vec3(sums) * (1 / sums.w);
      for (int k = 0; k < 3; ++k) ASSERT_NEAR(value[k], bounded[k], 1.0F / 32) << round;
      ++checked;
    }
  }
  EXPECT_GT(checked, 5000);
  EXPECT_GT(improper, 50);
}

}  // namespace
}  // namespace delray::raster
