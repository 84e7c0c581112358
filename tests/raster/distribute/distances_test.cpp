// Distances of depths, in planes and in rectangles of images.
#include "raster/distribute/distances.h"

#include <gtest/gtest.h>

#include <vector>

#include "raster/pipeline/screen.h"

namespace delray::raster {
namespace {

scenes::View view_of(bool is_orthographic) {
  scenes::Camera camera;
  camera.near = 0.5F;
  if (is_orthographic) camera.height = 2, camera.far = 10;
  return scenes::make_view(camera, 640, 480);
}

// Depths of all kinds, empty ones among them, in runs and one by one.
std::vector<float> depths_of(std::size_t count) {
  std::vector<float> depths(count);
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_empty = i % 7 == 3 || i / 64 % 3 == 1;
    depths[i] = is_empty ? image::kEmptyDepth : -1.0F / static_cast<float>(1 + i % 1000);
  }
  return depths;
}

TEST(Distances, AreMadeOfDepthsAndOfNothingElse) {
  for (const bool is_orthographic : {false, true}) {
    const scenes::View view = view_of(is_orthographic);
    for (const std::size_t count : {0U, 1U, 63U, 64U, 65U, 100001U}) {
      const std::vector<float> depths = depths_of(count);
      std::vector<float> made = depths;
      to_distances(made, view);
      for (std::size_t i = 0; i < count; ++i) {
        ASSERT_EQ(made[i], depths[i] < 0 ? distance_of(depths[i], view) : depths[i]) << i;
        ASSERT_GE(made[i], 0);
      }
      std::vector<float> again = made;
      to_distances(again, view);
      EXPECT_EQ(again, made);
    }
  }
}

// Large and small rectangles of a window, also empty ones, and nothing beside them.
TEST(Distances, AreMadeInRectangles) {
  const scenes::View view = view_of(false);
  for (const geometry::Rect& rect : {geometry::Rect{0, 0, 0, 0},
                                     {0, 0, 400, 300},
                                     {10, 20, 390, 280},
                                     {5, 5, 5, 200},
                                     {399, 299, 400, 300},
                                     {7, 0, 8, 300}}) {
    image::Image8 image(400, 300);
    const std::vector<float> depths = depths_of(image.pixels());
    std::copy(depths.begin(), depths.end(), image.depth.data());
    to_distances(rect, window_of(image), view);
    std::size_t i = 0;
    for (int y = 0; y < 300; ++y) {
      for (int x = 0; x < 400; ++x, ++i) {
        ASSERT_EQ(image.depth.data()[i],
                  rect.contains(x, y) && depths[i] < 0 ? distance_of(depths[i], view) : depths[i])
            << x << ", " << y;
      }
    }
  }
}

}  // namespace
}  // namespace delray::raster
