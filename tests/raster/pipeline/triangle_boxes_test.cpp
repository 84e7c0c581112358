#include "raster/pipeline/triangle_boxes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "raster/pipeline/set_up.h"
#include "tests/raster/coverage.h"
#include "tests/support/targets.h"

namespace delray::raster {
namespace {

// Small triangles, and some of all sizes, also beyond the frame.
scenes::Mesh random_mesh(unsigned seed, int triangles) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> both(-1, 1);
  scenes::Mesh mesh;
  for (int i = 0; i < triangles; ++i) {
    const glm::vec3 centre(1.5F * both(random), 1.2F * both(random), -2);
    const float size = i % 16 == 0 ? 0.9F : i % 3 == 0 ? 0.1F : 0.01F;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int k = 0; k < 3; ++k)
      mesh.positions.push_back(centre + size * glm::vec3(both(random), both(random), 0));
    mesh.triangles.emplace_back(first, first + 1, first + 2);
  }
  return mesh;
}

TEST(TriangleBoxes, AreThoseOfSetUp) {
  const scenes::Mesh mesh = random_mesh(5, 85);  // of one cluster
  tests::for_each_target([&] {
    for (const int hidden_side : {0, 1, -1}) {
      for (const int width : {60, 700}) {
        const Screen screen = make_screen(plain_view(width, width * 3 / 5));
        PreparedMesh prepared(screen, mesh);
        prepared.draw.hidden_side = hidden_side;
        const ClusterBlock& block = prepared.list.block_of(prepared.list.clusters[0]);
        const MeshCluster& cluster = block.clusters[0];
        ASSERT_EQ(cluster.count, 85U);
        ScreenVertices vertices;
        transform(prepared.draw.to_view, screen, mesh.positions, block.vertices_of(cluster),
                  vertices);
        ASSERT_FALSE(vertices.any_outside);
        TriangleBoxes boxes;
        find_boxes({screen, prepared.draw, block, cluster, vertices}, boxes);
        std::vector<std::int64_t> pixels(cluster.count);
        std::vector<geometry::Rect> rects(cluster.count);
        bool any_alone = false;
        int culled = 0, kept = 0;
        for (std::uint32_t place = 0; place < cluster.count; ++place) {
          set_up({screen, prepared.draw, block, cluster, vertices}, place, 0,
                 [&](const ScreenTriangle& t, const geometry::Rect& box) {
                   const std::int64_t area =
                       doubled_area(t.vertex[0], t.vertex[1], t.vertex[2]) >> 17;
                   pixels[place] = std::min(area + 1, box.area());
                   rects[place] = box;
                 });
          if (boxes.pixels[place] == TriangleBoxes::kAlone) {
            any_alone = true;
            pixels[place] = 0;
            rects[place] = {};
            continue;
          }
          ASSERT_EQ(boxes.pixels[place], pixels[place]) << place;
          EXPECT_LE(rects[place].area(), kLargeBox);
          (pixels[place] == 0 ? culled : kept)++;
          if (pixels[place] > 0) {
            EXPECT_EQ(boxes.box(place), rects[place]) << place;
          }
        }
        EXPECT_EQ(boxes.any_alone, any_alone);
        EXPECT_GT(culled, 0);
        EXPECT_GT(kept, 0);
        for (const auto& [begin, end] : {std::pair{0U, 85U}, {3U, 3U}, {17U, 50U}, {84U, 85U}}) {
          const SumOfBoxes sum = sum_of(boxes, begin, end);
          SumOfBoxes expected;
          for (std::uint32_t place = begin; place < end; ++place) {
            if (pixels[place] == 0) continue;
            const geometry::Rect& box = rects[place];
            expected.box = expected.triangles == 0
                               ? box
                               : geometry::Rect{std::min(expected.box.x0, box.x0),
                                                std::min(expected.box.y0, box.y0),
                                                std::max(expected.box.x1, box.x1),
                                                std::max(expected.box.y1, box.y1)};
            ++expected.triangles;
            expected.pixels += static_cast<std::uint64_t>(pixels[place]);
          }
          EXPECT_EQ(sum.triangles, expected.triangles);
          EXPECT_EQ(sum.pixels, expected.pixels);
          EXPECT_EQ(sum.box, expected.box);
        }
      }
    }
  });
}

}  // namespace
}  // namespace delray::raster
