#include "raster/internal/shade_gouraud.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "image/srgb.h"
#include "raster/internal/draw_into_tiles.h"
#include "scenes/generate.h"
#include "tests/raster/random_scene.h"
#include "tests/raster/targets.h"

namespace delray::raster {
namespace {

template <class Colour>
void expect_same(const image::BasicImage<Colour>& a, const image::BasicImage<Colour>& b) {
  EXPECT_EQ(std::memcmp(a.colour.data(), b.colour.data(), a.pixels() * sizeof(Colour)), 0);
  EXPECT_EQ(std::memcmp(a.depth.data(), b.depth.data(), a.pixels() * sizeof(float)), 0);
}

// Shades a scene by vectors, on every target, and pixel by pixel.
template <class Colour>
void expect_as_pixel_by_pixel(const scenes::Scene& scene, const scenes::Camera& camera, int width,
                              int height) {
  const Screen screen = make_screen(scenes::make_view(camera, width, height));
  const shading::Shader shader = shading::make_shader(scene);
  SceneClusters clusters(scene.meshes);
  const std::vector<std::uint64_t> first = scenes::first_primitives(scene);
  const DrawList list = make_draw_list(pieces_of(scene, first, 0, first.back()), &clusters);
  const std::vector<PreparedDraw> draws = prepare_draws(screen, list, shader, false);
  const geometry::Rect frame_rect = screen.frame();
  const TileJobs jobs = make_tile_jobs(screen, {&frame_rect, 1});
  const DrawIntoTiles task{
      screen, list, draws, jobs.wanted, true, [](std::uint32_t, int, int) { return true; }, {}};
  FrameTiles tiles;
  std::vector<std::unique_ptr<Worker>> workers;
  LaterTriangles later;
  DrawCosts costs;
  tiles.begin(screen, jobs);
  draw_into_tiles(task, tiles, workers, later, costs);
  for (const TileJob& job : jobs.jobs) draw_large(task, job.tile, later.large, tiles);

  const FrameShading frame =
      make_frame_shading(screen, shader, list, Lighting::gouraud, width % 2 == 0);
  SeenTriangles seen;
  seen.clear();
  GouraudTile gouraud;
  image::BasicImage<Colour> expected(width, height), image(width, height);
  std::uint64_t shown = 0;
  for (const TileJob& job : jobs.jobs)
    shown +=
        shade_tile(frame, seen, tiles.open(job.tile), screen.tile(job.tile), window_of(expected));
  for_each_target([&] {
    image::clear(image);
    std::uint64_t shown_by_vectors = 0;
    for (const TileJob& job : jobs.jobs) {
      // Whole, or in two parts of which the first ends within a vector.
      const geometry::Rect r = screen.tile(job.tile);
      const int x = job.tile % 2 == 0 ? r.x1 : std::min(r.x0 + 23, r.x1);
      for (const geometry::Rect& part :
           {geometry::Rect{r.x0, r.y0, x, r.y1}, geometry::Rect{x, r.y0, r.x1, r.y1}})
        if (!part.empty())
          shown_by_vectors +=
              gouraud.shade(frame, seen, tiles.open(job.tile), part, window_of(image));
    }
    EXPECT_EQ(shown_by_vectors, shown);
    expect_same(image, expected);
  });
  EXPECT_GT(shown, expected.pixels() / 4);
}

TEST(ShadeGouraud, GivesWhatPixelByPixelGives) {
  for (unsigned seed = 0; seed < 3; ++seed) {
    const scenes::Scene scene = random_scene(seed);
    expect_as_pixel_by_pixel<image::Rgba8>(scene, random_scene_camera(), 131, 97);
    expect_as_pixel_by_pixel<image::RgbaF>(scene, random_scene_camera(), 66, 130);
  }
  for (const char* name : {"gen:terrain:40000", "gen:city:3000", "gen:field:20000"}) {
    SCOPED_TRACE(name);
    const scenes::Scene scene = scenes::generate(name);
    expect_as_pixel_by_pixel<image::Rgba8>(scene, scene.cameras[0], 150, 100);
  }
}

TEST(ShadeGouraud, LightsCornersWithoutNormalsAsTheirTriangles) {
  scenes::Scene scene = random_scene(4);
  for (scenes::Mesh& mesh : scene.meshes) mesh.normals.clear();
  expect_as_pixel_by_pixel<image::Rgba8>(scene, random_scene_camera(), 80, 70);
  scene = random_scene(5);
  for (scenes::Mesh& mesh : scene.meshes)
    for (std::size_t i = 0; i < mesh.normals.size(); i += 2) mesh.normals[i] = glm::vec3(0.0F);
  expect_as_pixel_by_pixel<image::Rgba8>(scene, random_scene_camera(), 80, 70);
}

TEST(ShadeGouraud, RowsEncodeEveryColourAsPixelsDo) {
  // Colours around every step of the code, and those that are none.
  std::vector<float> colours = {0.0F, -1.0F, 1.0F, 2.0F, 1e30F, 1e-30F, 0x1p-13F};
  for (int code = 1; code < 256; ++code) {
    const float least = image::internal::kLeastOfCode[static_cast<std::size_t>(code)];
    colours.push_back(least);
    colours.push_back(std::nextafter(least, 0.0F));
    colours.push_back(std::nextafter(least, 1.0F));
  }
  std::mt19937 random(6);
  std::uniform_real_distribution<float> unit(0, 1);
  for (int i = 0; i < 5000; ++i) colours.push_back(unit(random) * unit(random));
  for_each_target([&] {
    for (const float colour : colours) {
      PixelTriangle flat{};
      flat.c[0] = flat.c[2] = colour;
      flat.c[3] = 1;
      const std::uint16_t runs[] = {0, kNoTriangle, 0};
      image::Rgba8 pixels[kBlockSize];
      shade_row({&flat, 1}, 7, runs, 5, 7, 3, pixels);
      const std::uint8_t code = image::encode_srgb(colour);
      ASSERT_EQ(pixels[0], (image::Rgba8{code, 0, code, 255})) << colour;
      ASSERT_EQ(pixels[1], image::Rgba8());
      ASSERT_EQ(pixels[2], pixels[0]);
    }
  });
}

}  // namespace
}  // namespace delray::raster
