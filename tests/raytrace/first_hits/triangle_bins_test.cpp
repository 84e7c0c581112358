#include "raytrace/first_hits/triangle_bins.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <random>
#include <tuple>

#include "parallel/arena.h"
#include "raytrace/tracer.h"
#include "tests/raytrace/small_scenes.h"
#include "tests/support/targets.h"

namespace delray::raytrace {
namespace {

// Triangles in front of the eye, from less than a pixel to all of the picture.
scenes::Scene some_triangles(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> both(-1, 1), unit(0, 1);
  const auto point = [&](float side) {
    const float x = both(random), y = both(random), z = both(random);
    return glm::vec3(x, y, z) * side;
  };
  scenes::Mesh mesh;
  for (std::uint32_t i = 0; i < 700; ++i) {
    const float size = std::pow(10.0F, -2.5F * unit(random));
    const glm::vec3 at = point(1);
    mesh.positions.insert(mesh.positions.end(), {at, at + point(size), at + point(size)});
    mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  scenes::Scene scene;
  add(scene, std::move(mesh));
  return scene;
}

scenes::View view_from(float z, int width, int height) {
  scenes::Camera camera;
  camera.eye = {0, 0, z};
  return scenes::make_view(camera, width, height);
}

TriangleBins bins_of(const Tracer& tracer, const SeenWindow& window, int threads) {
  TriangleBins bins;
  parallel::Arena arena(threads);
  arena.execute([&] {
    const RaySpaces spaces =
        ray_spaces(tracer.embree, tracer.instances, window.view, window.longest);
    std::vector<SeenTriangles> seen;
    const auto size = static_cast<std::uint32_t>(tracer.instances[0].mesh->triangles.size());
    constexpr std::uint32_t kPart = 37;  // not a multiple of a vector
    for (std::uint32_t first = 0; first < size; first += kPart) {
      seen.push_back(find_seen(tracer.instances[0], 0, spaces.of(0), window, first,
                               std::min(size, first + kPart)));
    }
    bins = bin_triangles(seen, window.pixels);
  });
  return bins;
}

std::vector<std::tuple<std::uint32_t, float, std::uint32_t>> all_of(const TriangleBins& bins) {
  std::vector<std::tuple<std::uint32_t, float, std::uint32_t>> all;
  for (std::uint32_t i = 0; i < bins.first.back(); ++i) {
    const BinnedTriangle& t = bins.triangles[i];
    all.emplace_back(t.triangle, t.nearest, t.blocks);
  }
  return all;
}

TEST(TriangleBins, HaveEveryTriangleThatARayMeetsOnEveryTarget) {
  const scenes::Scene scene = some_triangles(5);
  const Tracer tracer = make_tracer(scene);
  const scenes::View view = view_from(4, 230, 150);
  const SeenWindow window{view, {13, 7, 230, 150}, 2.0F};
  const scenes::Mesh& mesh = scene.meshes[0];
  tests::for_each_target([&] {
    const TriangleBins bins = bins_of(tracer, window, 1);
    ASSERT_EQ(bins.columns, 14);
    ASSERT_EQ(bins.rows, 9);
    std::size_t met = 0;
    for (int y = window.pixels.y0; y < window.pixels.y1; y += 3) {
      for (int x = window.pixels.x0; x < window.pixels.x1; ++x) {
        const glm::dvec3 to(view.ray(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F));
        const int column = x - window.pixels.x0, row = y - window.pixels.y0;
        const auto bin = bins.of(bins.square(column / kBinSide, row / kBinSide));
        const int block =
            kBinBlocks * (row % kBinSide / kBlockSide) + column % kBinSide / kBlockSide;
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
          glm::dvec3 corner[3];
          for (int k = 0; k < 3; ++k)
            corner[k] = glm::dvec3(mesh.positions[mesh.triangles[i][k]] - view.eye);
          const double u = glm::dot(to, glm::cross(corner[0], corner[1]));
          const double v = glm::dot(to, glm::cross(corner[1], corner[2]));
          const double w = glm::dot(to, glm::cross(corner[2], corner[0]));
          if (std::min({u, v, w}) <= 0 && std::max({u, v, w}) >= 0) continue;
          ++met;
          const auto found = std::ranges::find(bin, i, &BinnedTriangle::triangle);
          ASSERT_NE(found, bin.end()) << i << " at " << x << ", " << y;
          ASSERT_TRUE((found->blocks >> block & 1) != 0) << i << " at " << x << ", " << y;
          const double depth = glm::dot(corner[0], glm::cross(corner[1], corner[2])) / (u + v + w);
          ASSERT_LE(found->nearest, depth);
        }
      }
    }
    EXPECT_GT(met, 3000U);
    for (std::size_t square = 0; square < bins.blocks.size(); ++square) {
      std::uint32_t sum = 0;
      for (const BinnedTriangle& t : bins.of(square)) {
        EXPECT_EQ(std::popcount(t.blocks & 0xFFFFU), count(t.blocks));
        sum += static_cast<std::uint32_t>(count(t.blocks));
      }
      EXPECT_EQ(sum, bins.blocks[square]);
    }
  });
}

TEST(TriangleBins, AreTheSameForEveryNumberOfThreads) {
  const scenes::Scene scene = some_triangles(6);
  const Tracer tracer = make_tracer(scene);
  const scenes::View view = view_from(2, 300, 200);
  const SeenWindow window{view, {0, 0, 300, 200}, 2.0F};
  const TriangleBins one = bins_of(tracer, window, 1);
  for (const int threads : {2, 5, 40}) {
    const TriangleBins several = bins_of(tracer, window, threads);
    EXPECT_EQ(several.first, one.first);
    EXPECT_EQ(several.blocks, one.blocks);
    EXPECT_EQ(all_of(several), all_of(one));
  }
}

}  // namespace
}  // namespace delray::raytrace
