// A tile's shading by vectors beside shading pixel by pixel.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <random>

#include "raster/pipeline/draw_into_tiles.h"
#include "raster/shading/shade_tile.h"
#include "raster/shading/tile_triangles.h"
#include "scenes/generate.h"
#include "tests/raster/random_scene.h"
#include "tests/support/targets.h"

namespace delray::raster {

template <class Colour>
void expect_same(const image::BasicImage<Colour>& a, const image::BasicImage<Colour>& b) {
  EXPECT_EQ(std::memcmp(a.colour.data(), b.colour.data(), a.pixels() * sizeof(Colour)), 0);
  EXPECT_EQ(std::memcmp(a.depth.data(), b.depth.data(), a.pixels() * sizeof(float)), 0);
}

// Shades a scene by vectors, on every target, and pixel by pixel.
template <class Colour, class Tile>
void expect_as_pixel_by_pixel(const scenes::Scene& scene, const scenes::Camera& camera, int width,
                              int height, Lighting lighting) {
  const Screen screen = make_screen(scenes::make_view(camera, width, height));
  const shading::Shader shader = shading::make_shader(scene);
  SceneClusters clusters(scene.meshes);
  const std::vector<std::uint64_t> first = scenes::first_primitives(scene);
  const DrawList list = make_draw_list(pieces_of(scene, first, 0, first.back()), &clusters);
  const std::vector<PreparedDraw> draws = prepare_draws(screen, list, shader, false);
  const geometry::Rect frame_rect = screen.frame();
  const TileJobs jobs = make_tile_jobs(screen, {&frame_rect, 1});
  const DrawIntoTiles task{screen, list,
                           draws,  jobs.clip,
                           true,   [](std::size_t, std::uint32_t, int, int) { return true; },
                           {}};
  FrameTiles tiles;
  std::vector<std::unique_ptr<Worker>> workers;
  DeferredTriangles deferred;
  DrawCosts costs;
  tiles.begin(screen, jobs);
  draw_into_tiles(task, tiles, workers, deferred, costs);
  for (const TileJob& job : jobs.jobs) {
    if (deferred.large.of_tile(job.tile).empty()) continue;
    draw_large(task, 0, deferred.large, {job.tile, tiles.rect(job.tile), tiles.open(job.tile)});
  }

  const FrameShading frame = make_frame_shading(screen, shader, list, lighting, width % 2 == 0);
  SeenTriangles seen;
  seen.clear();
  const auto by_vectors = std::make_unique<Tile>();
  image::BasicImage<Colour> expected(width, height), image(width, height);
  std::uint64_t shown = 0;
  for (const TileJob& job : jobs.jobs) {
    shown +=
        shade_tile(frame, seen, tiles.open(job.tile), screen.tile(job.tile), window_of(expected));
  }
  tests::for_each_target([&] {
    image::clear(image);
    std::uint64_t shown_by_vectors = 0;
    for (const TileJob& job : jobs.jobs) {
      // Whole, or in two parts of which the first ends within a vector.
      const geometry::Rect r = screen.tile(job.tile);
      const int x = job.tile % 2 == 0 ? r.x1 : std::min(r.x0 + 23, r.x1);
      for (const geometry::Rect& part :
           {geometry::Rect{r.x0, r.y0, x, r.y1}, geometry::Rect{x, r.y0, r.x1, r.y1}}) {
        if (!part.empty()) {
          shown_by_vectors +=
              by_vectors->shade(frame, seen, tiles.open(job.tile), part, window_of(image));
        }
      }
    }
    EXPECT_EQ(shown_by_vectors, shown);
    expect_same(image, expected);
  });
  EXPECT_GT(shown, expected.pixels() / 4);
}

// The same for scenes of many kinds, and for meshes that have no normals, or not everywhere.
template <class Tile>
void expect_vectors_give_what_pixels_give(Lighting lighting) {
  const auto both = [&]<class Colour>(const scenes::Scene& scene, const scenes::Camera& camera,
                                      int width, int height, Colour) {
    expect_as_pixel_by_pixel<Colour, Tile>(scene, camera, width, height, lighting);
  };
  for (unsigned seed = 0; seed < 3; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = random_scene(seed);
    both(scene, random_scene_camera(), 131, 97, image::Rgba8());
    both(scene, random_scene_camera(), 66, 130, image::RgbaF());
  }
  both(with_second_uvs(random_scene(3)), random_scene_camera(), 131, 97, image::Rgba8());
  for (const char* name : {"gen:terrain:40000", "gen:city:3000", "gen:field:20000"}) {
    SCOPED_TRACE(name);
    const scenes::Scene scene = scenes::generate(name);
    both(scene, scene.cameras[0], 150, 100, image::Rgba8());
  }
  scenes::Scene scene = random_scene(4);
  for (scenes::Mesh& mesh : scene.meshes) mesh.normals.clear();
  both(scene, random_scene_camera(), 80, 70, image::Rgba8());
  scene = random_scene(5);
  for (scenes::Mesh& mesh : scene.meshes)
    for (std::size_t i = 0; i < mesh.normals.size(); i += 2) mesh.normals[i] = glm::vec3(0.0F);
  both(scene, random_scene_camera(), 80, 70, image::Rgba8());
}

// Surfaces by vectors and each alone.
template <class Tile>
void expect_colours_of_each_alone(Lighting lighting) {
  for (unsigned seed = 20; seed < 23; ++seed) {
    SCOPED_TRACE(seed);
    scenes::Scene scene = random_scene(seed);
    for (std::size_t m = 0; m < scene.materials.size(); m += 2) {
      scene.materials[m].alpha = scenes::Material::Alpha::blend;
      scene.materials[m].base_colour.w = 0.3F;
    }
    const Screen screen = make_screen(scenes::make_view(random_scene_camera(), 120, 90));
    const shading::Shader shader = shading::make_shader(scene);
    SceneClusters clusters(scene.meshes);
    const std::vector<std::uint64_t> first = scenes::first_primitives(scene);
    const DrawList list = make_draw_list(pieces_of(scene, first, 0, first.back()), &clusters);
    const FrameShading frame = make_frame_shading(screen, shader, list, lighting, false);
    // Any triangles at the pixels of their boxes, some of them slivers, in any order.
    std::vector<SurfaceAt> surfaces;
    std::mt19937 random(seed);
    for (int i = 0; i < 9000; ++i) {
      const auto cluster = static_cast<std::uint32_t>(random() % list.clusters.size());
      const Cluster& its = list.clusters[cluster];
      const std::uint32_t place =
          its.begin + static_cast<std::uint32_t>(random()) % (its.end - its.begin);
      surfaces.push_back({cluster << kClusterBits | place, static_cast<int>(random() % 120),
                          static_cast<int>(random() % 90)});
    }
    SeenTriangles seen;
    seen.clear();
    std::vector<image::RgbaF> expected, colours(surfaces.size());
    for (const SurfaceAt& s : surfaces)
      expected.push_back(colour_at(frame, seen, s.number, s.x, s.y));
    const auto tile = std::make_unique<Tile>();
    std::size_t through = 0;
    tests::for_each_target([&] {
      tile->colours(frame, seen, surfaces, colours.data());
      for (std::size_t i = 0; i < colours.size(); ++i) {
        // A pixel may lie outside of its triangle here, where there is nothing to agree on.
        const auto finite = [](const image::RgbaF& c) {
          return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b);
        };
        if (!finite(expected[i])) continue;
        ASSERT_EQ(std::memcmp(&colours[i], &expected[i], sizeof colours[i]), 0) << i;
        through += colours[i].a < 1;
      }
    });
    EXPECT_GT(through, 100U);
  }
}

}  // namespace delray::raster
