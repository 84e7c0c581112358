// Small float pictures that must not change unless somebody means it.
//
// With DELRAY_UPDATE_GOLDEN=1 in the environment the pictures of tests/golden/ are written anew. On
// a mismatch expected, actual and difference are written beside the test program.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <ostream>

#include "comm/threads.h"
#include "image/compare.h"
#include "image/io.h"
#include "image/srgb.h"
#include "raster/render.h"
#include "raytrace/render.h"
#include "scenes/generate.h"

namespace delray::tests {
namespace {

namespace fs = std::filesystem;
constexpr int kGoldenWidth = 96, kGoldenHeight = 64;

image::ImageF draw(const scenes::Scene& scene, const scenes::Camera& camera) {
  image::ImageF picture;
  comm::run_threads(1, 1, [&](comm::Communicator& communicator) {
    raster::RenderOptions options;
    options.width = kGoldenWidth;
    options.height = kGoldenHeight;
    options.float_pixels = true;
    picture = std::get<image::ImageF>(raster::render(communicator, scene, camera, options).picture);
  });
  return picture;
}

image::ImageF trace(const scenes::Scene& scene, const scenes::Camera& camera) {
  image::ImageF picture;
  comm::run_threads(1, 1, [&](comm::Communicator& communicator) {
    raytrace::RenderOptions options;
    options.width = kGoldenWidth;
    options.height = kGoldenHeight;
    options.build.isa = "avx2";  // Embree's last bits depend on it
    picture = raytrace::render(communicator, scene, camera, options).image;
  });
  return picture;
}

struct Golden {
  const char* name;
  const char* scene;
  image::ImageF (*make)(const scenes::Scene&, const scenes::Camera&);
  // Pixels that may differ by more than a code of 8 bits: none for the rasterizer, whose arithmetic
  // is fixed; a few silhouettes for Embree, whose is fixed per instruction set.
  std::uint64_t tolerated;
  friend void PrintTo(const Golden& golden, std::ostream* out) { *out << golden.name; }
};

// The pixels that differ by more than one code of 8 bits.
std::uint64_t visibly_different(const image::Image8& a, const image::Image8& b) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < a.pixels(); ++i) {
    const image::Rgba8 p = a.colour[i], q = b.colour[i];
    const auto differs = [](int x, int y) { return std::abs(x - y) > 1; };
    count += differs(p.r, q.r) || differs(p.g, q.g) || differs(p.b, q.b) || differs(p.a, q.a);
  }
  return count;
}

class GoldenPicture : public testing::TestWithParam<Golden> {};

TEST_P(GoldenPicture, IsWhatItWas) {
  const Golden& golden = GetParam();
  const scenes::Scene scene = scenes::generate(golden.scene);
  ASSERT_FALSE(scene.cameras.empty());
  const image::ImageF actual = golden.make(scene, scene.cameras.front());
  const fs::path path =
      fs::path(DELRAY_SOURCE_DIR) / "tests/golden" / (std::string(golden.name) + ".exr");
  if (std::getenv("DELRAY_UPDATE_GOLDEN") != nullptr) {
    image::write_image(path, actual);
    return;
  }
  const image::ImageF expected = image::read_image_float(path);
  ASSERT_EQ(expected.width, kGoldenWidth);
  ASSERT_EQ(expected.height, kGoldenHeight);
  const image::Comparison comparison = image::compare(expected, actual);
  const image::Image8 expected8 = image::to_8bit(expected), actual8 = image::to_8bit(actual);
  const bool same = golden.tolerated == 0
                        ? comparison.equal()
                        : visibly_different(expected8, actual8) <= golden.tolerated;
  if (same) return;
  const std::string stem = std::string("golden-") + golden.name;
  image::write_image(stem + "-expected.exr", expected);
  image::write_image(stem + "-actual.exr", actual);
  image::write_image(stem + "-difference.png", image::difference_picture(expected8, actual8));
  ADD_FAILURE() << comparison.colour_differs << " pixels differ in colour, "
                << comparison.depth_differs << " in depth, by at most "
                << comparison.max_channel_difference << "; see " << fs::absolute(stem) << "-*";
}

INSTANTIATE_TEST_SUITE_P(Pictures, GoldenPicture,
                         testing::Values(Golden{"raster-terrain", "gen:terrain:2000", draw, 0},
                                         Golden{"raster-spheres", "gen:spheres:4000", draw, 0},
                                         Golden{"raster-cornell", "gen:cornell:500", draw, 0},
                                         Golden{"raster-city", "gen:city:3000", draw, 0},
                                         Golden{"raytrace-spheres", "gen:spheres:4000", trace, 30},
                                         Golden{"raytrace-cornell", "gen:cornell:500", trace, 30}),
                         [](const auto& test) {
                           std::string name = test.param.name;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace delray::tests
