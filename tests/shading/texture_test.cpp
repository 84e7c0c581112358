#include "shading/texture.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "image/srgb.h"
#include "shading/take_shader.h"

namespace delray::shading {
namespace {

using Wrap = scenes::Texture::Wrap;

scenes::Texture blank(int width, int height, image::Rgba8 texel, bool srgb = false) {
  scenes::Texture texture;
  texture.width = width;
  texture.height = height;
  texture.srgb = srgb;
  texture.texels.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), texel);
  return texture;
}

scenes::Texture noise(int width, int height, std::uint32_t seed) {
  std::mt19937 random(seed);
  scenes::Texture texture = blank(width, height, {0, 0, 0, 255});
  for (image::Rgba8& t : texture.texels) {
    t = {static_cast<std::uint8_t>(random()), static_cast<std::uint8_t>(random()),
         static_cast<std::uint8_t>(random()), 255};
  }
  return texture;
}

TEST(Texture, HasTheRightLevels) {
  const Texture texture = make_texture(blank(13, 4, {1, 2, 3, 4}));
  ASSERT_EQ(texture.levels.size(), 4U);
  EXPECT_EQ(texture.levels[1].width, 6);
  EXPECT_EQ(texture.levels[1].height, 2);
  EXPECT_EQ(texture.levels[3].width, 1);
  EXPECT_EQ(texture.levels[3].height, 1);
  for (const image::Rgba8& t : texture.texels) EXPECT_EQ(t, (image::Rgba8{1, 2, 3, 4}));
}

TEST(Texture, AveragesInLinearLight) {
  scenes::Texture board = blank(2, 2, {0, 0, 0, 255}, true);
  board.texels[1] = board.texels[2] = {255, 255, 255, 255};
  const Texture texture = make_texture(board);
  const std::uint8_t half = image::encode_srgb(0.5F);
  EXPECT_EQ(texture.texels[texture.levels[1].first], (image::Rgba8{half, half, half, 255}));
}

TEST(Texture, TransparentTexelsLendNoColour) {
  scenes::Texture leaf = blank(2, 1, {0, 200, 0, 255});
  leaf.texels[1] = {255, 0, 255, 0};
  const Texture texture = make_texture(leaf);
  EXPECT_EQ(texture.texels[1 * 2], (image::Rgba8{0, 200, 0, 128}));
}

TEST(Texture, OddSizesKeepTheMean) {
  for (std::uint32_t seed = 1; seed < 20; ++seed) {
    std::mt19937 random(seed);
    const int width = 1 + static_cast<int>(random() % 9),
              height = 1 + static_cast<int>(random() % 9);
    const scenes::Texture source = noise(width, height, seed);
    const Texture texture = make_texture(source);
    double sum = 0;
    for (const image::Rgba8& t : source.texels) sum += t.r;
    const double mean = sum / static_cast<double>(source.texels.size());
    // Each level rounds to the nearest code, which is off by half of one at most.
    const double tolerance = 0.5 * static_cast<double>(texture.levels.size()) + 1e-3;
    EXPECT_NEAR(texture.texels.back().r, mean, tolerance)
        << width << "x" << height << " seed " << seed;
  }
}

TEST(Texture, TexelCentresGiveTexels) {
  const scenes::Texture source = noise(5, 3, 11);
  const Texture texture = make_texture(source);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 5; ++x) {
      const glm::vec2 uv((static_cast<float>(x) + 0.5F) / 5.0F,
                         (static_cast<float>(y) + 0.5F) / 3.0F);
      const glm::vec4 c = sample(texture, uv, 0.0F);
      EXPECT_NEAR(c.x * 255.0F, source.texels[y * 5 + x].r, 1e-3);
      EXPECT_NEAR(c.z * 255.0F, source.texels[y * 5 + x].b, 1e-3);
    }
  }
}

TEST(Texture, InterpolatesBetweenTexels) {
  scenes::Texture two = blank(2, 1, {0, 0, 0, 255});
  two.texels[1] = {255, 255, 255, 255};
  two.wrap_u = Wrap::clamp;
  const Texture texture = make_texture(two);
  EXPECT_NEAR(sample(texture, {0.5F, 0.5F}, 0.0F).x, 0.5F, 1e-6);
  EXPECT_NEAR(sample(texture, {0.375F, 0.5F}, 0.0F).x, 0.25F, 1e-6);
}

TEST(Texture, WrapsAsAsked) {
  scenes::Texture two = blank(2, 1, {0, 0, 0, 255});
  two.texels[1] = {255, 255, 255, 255};
  const auto at = [&](Wrap wrap, float u) {
    two.wrap_u = wrap;
    return sample(make_texture(two), {u, 0.5F}, 0.0F).x;
  };
  EXPECT_NEAR(at(Wrap::repeat, 1.25F), 0.0F, 1e-6);
  EXPECT_NEAR(at(Wrap::repeat, -0.25F), 1.0F, 1e-6);
  EXPECT_NEAR(at(Wrap::repeat, 1.0F), 0.5F, 1e-6);
  EXPECT_NEAR(at(Wrap::mirror, 1.25F), 1.0F, 1e-6);
  EXPECT_NEAR(at(Wrap::mirror, -0.25F), 0.0F, 1e-6);
  EXPECT_NEAR(at(Wrap::mirror, 1.0F), 1.0F, 1e-6);
  EXPECT_NEAR(at(Wrap::clamp, 7.0F), 1.0F, 1e-6);
  EXPECT_NEAR(at(Wrap::clamp, -7.0F), 0.0F, 1e-6);
}

TEST(Texture, LevelFollowsTheFootprint) {
  const Texture texture = make_texture(blank(64, 16, {9, 9, 9, 9}));
  EXPECT_EQ(mip_level(texture, {}), 0.0F);
  EXPECT_EQ(mip_level(texture, {{1.0F / 128, 0}, {0, 0}}), 0.0F);
  EXPECT_NEAR(mip_level(texture, {{4.0F / 64, 0}, {0, 0}}), 2.0F, 1e-6);
  EXPECT_NEAR(mip_level(texture, {{0, 0}, {0, 4.0F / 16}}), 2.0F, 1e-6);
  EXPECT_EQ(mip_level(texture, {{100, 0}, {0, 0}}), 6.0F);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(mip_level(texture, {{nan, 0}, {nan, 0}}), 6.0F);
  EXPECT_EQ(mip_level(texture, {{1e30F, 1e30F}, {0, 0}}), 6.0F);
}

TEST(Texture, BlendsNeighbouringLevels) {
  scenes::Texture board = blank(2, 2, {0, 0, 0, 255});
  board.texels[0] = {255, 255, 255, 255};
  const Texture texture = make_texture(board);
  const float sharp = sample(texture, {0.25F, 0.25F}, 0.0F).x;
  const float blurred = sample(texture, {0.25F, 0.25F}, 1.0F).x;
  EXPECT_NEAR(sharp, 1.0F, 1e-6);
  EXPECT_NEAR(blurred, 64.0F / 255.0F, 1e-6);
  EXPECT_NEAR(sample(texture, {0.25F, 0.25F}, 0.25F).x, 0.75F * sharp + 0.25F * blurred, 1e-6);
}

TEST(Texture, SurvivesOddCoordinates) {
  const Texture texture = make_texture(noise(7, 5, 3));
  const Texture empty = make_texture(scenes::Texture{});
  for (const float u : {0.0F, 1.0F, -1e-9F, 1e20F, -1e20F, std::numeric_limits<float>::infinity(),
                        std::numeric_limits<float>::quiet_NaN(), 0x1p24F, -0x1p24F}) {
    const glm::vec4 c = sample(texture, {u, u}, Footprint{});
    EXPECT_TRUE(c.x >= 0.0F && c.x <= 1.0F) << u;
    EXPECT_EQ(sample(empty, {u, u}, Footprint{}), glm::vec4(1.0F));
  }
}

TEST(Texture, RadianceHasNoUpperLimit) {
  scenes::Texture picture;
  picture.width = 4;
  picture.height = 2;
  picture.radiance.assign(8, glm::vec3(0.0F));
  picture.radiance[5] = {8000.0F, 80.0F, 0.8F};
  scenes::Scene scene;
  scene.textures.push_back(picture);
  scene.materials.resize(1);
  scene.materials[0].base_colour_texture = scene.materials[0].normal_texture = 0;
  const Texture copied = make_texture(picture), taken = take_texture(picture);
  EXPECT_TRUE(picture.radiance.empty());
  for (const Texture& texture : {copied, taken}) {
    EXPECT_EQ(texture.levels.size(), 3U);
    EXPECT_EQ(sample(texture, {0.375F, 0.75F}, 0.0F), glm::vec4(8000.0F, 80.0F, 0.8F, 1.0F));
    EXPECT_NEAR(sample(texture, {0.1F, 0.1F}, 2.0F).x, 1000.0F, 0.01F);
    EXPECT_EQ(sample_alpha(texture, {0.1F, 0.1F}, 1.0F), 1.0F);
  }
  // Not for surfaces, whose textures are of 8 bits.
  EXPECT_EQ(make_shader(scene).materials[0].base_colour_texture, scenes::kNone);
  EXPECT_EQ(make_shader(scene).materials[0].normal_texture, scenes::kNone);
}

TEST(Texture, TakenTexelsAreThoseOfACopy) {
  for (const auto& [width, height] : {std::pair{1, 1}, std::pair{7, 5}, std::pair{64, 64}}) {
    scenes::Texture source = noise(width, height, 4);
    source.texels.reserve(2 * source.texels.size());
    const image::Rgba8* const place = source.texels.data();
    const Texture copy = make_texture(source);
    EXPECT_EQ(source.texels.size(), static_cast<std::size_t>(width) * height);
    const Texture taken = take_texture(source);
    EXPECT_TRUE(source.texels.empty());
    EXPECT_EQ(source.width, width);
    EXPECT_EQ(taken.texels.data(), place);
    EXPECT_EQ(taken.texels, copy.texels);
    EXPECT_EQ(taken.opaque, copy.opaque);
    EXPECT_EQ(taken.levels.size(), copy.levels.size());
  }
}

}  // namespace
}  // namespace delray::shading
