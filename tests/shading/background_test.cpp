// Backgrounds behind pictures.
#include "shading/background.h"

#include <gtest/gtest.h>

#include "image/srgb.h"
#include "scenes/generate.h"

namespace delray::shading {
namespace {

using Kind = Background::Kind;

struct Behind {
  scenes::Scene scene = scenes::generate("gen:terrain:100");
  Shader shader = make_shader(scene);
  scenes::View view = scenes::make_view(scene.cameras[0], 8, 6);
};

template <class Colour>
image::BasicImage<Colour> picture_of(int width, int height, const Colour& colour) {
  image::BasicImage<Colour> picture(width, height);
  clear(picture, colour);
  return picture;
}

TEST(Background, ColourShowsThroughAsMuchAsPixelsLetIt) {
  const Behind behind;
  const Background background{Kind::colour, {0.5F, 0.25F, 1, 1}};
  image::ImageF light = picture_of<image::RgbaF>(8, 6, {0.1F, 0.2F, 0.3F, 0.5F});
  light.depth[7] = 2;
  put_behind(light, background, behind.shader, behind.view);
  EXPECT_FLOAT_EQ(light.colour[47].r, 0.35F);
  EXPECT_FLOAT_EQ(light.colour[47].g, 0.325F);
  EXPECT_FLOAT_EQ(light.colour[47].b, 0.8F);
  EXPECT_FLOAT_EQ(light.colour[47].a, 1);
  EXPECT_EQ(light.depth[7], 2);
  EXPECT_EQ(light.depth[8], image::kEmptyDepth);
  const image::Rgba8 opaque{10, 20, 30, 255};
  image::Image8 bytes = picture_of<image::Rgba8>(8, 6, {});
  bytes.colour[3] = opaque;
  put_behind(bytes, background, behind.shader, behind.view);
  EXPECT_EQ(bytes.colour[3], opaque);
  EXPECT_EQ(bytes.colour[4], image::to_8bit(background.colour));
}

TEST(Background, NoneLeavesThePictureAsItIs) {
  const Behind behind;
  image::Image8 picture = picture_of<image::Rgba8>(8, 6, {1, 2, 3, 4});
  put_behind(picture, {Kind::transparent, {}}, behind.shader, behind.view);
  for (const image::Rgba8& pixel : picture.colour.span())
    EXPECT_EQ(pixel, (image::Rgba8{1, 2, 3, 4}));
}

// A part of the frame has what the whole one has there.
TEST(Background, OfAPartIsThatOfTheFrame) {
  Behind behind;
  behind.shader.environment.ground = {0.1F, 0.2F, 0.3F};
  behind.shader.environment.zenith = {0.3F, 0.2F, 0.1F};
  for (const Kind kind : {Kind::studio, Kind::environment}) {
    image::ImageF whole = picture_of<image::RgbaF>(8, 6, {});
    image::ImageF part = picture_of<image::RgbaF>(3, 2, {});
    put_behind(whole, {kind, {}}, behind.shader, behind.view);
    put_behind(part, {kind, {}}, behind.shader, behind.view, {4, 3});
    for (int i = 0; i < 6; ++i)
      EXPECT_EQ(part.colour[i], whole.colour[(i / 3 + 3) * 8 + i % 3 + 4]);
    EXPECT_NE(whole.colour[0], whole.colour[40]);
  }
}

}  // namespace
}  // namespace delray::shading
