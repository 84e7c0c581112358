#include "image/tone.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace delray::image {
namespace {

TEST(Tone, CurvesNeverFallAndBeginAtBlack) {
  for (const ToneCurve& curve : tone_curves()) {
    EXPECT_EQ(curve.shown(0.0F), 0.0F) << curve.name;
    float last = 0.0F;
    for (float x = 0.0F; x < 1e8F; x = x * 1.02F + 1e-4F) {
      const float y = curve.shown(x);
      ASSERT_GE(y, last) << curve.name << " at " << x;
      last = y;
    }
    EXPECT_GE(last, 1.0F) << curve.name;
  }
}

TEST(Tone, FilmicKeepsWhatLinearCutsOff) {
  const ToneCurve& filmic = tone_curve("filmic");
  EXPECT_LE(filmic.shown(std::numeric_limits<float>::max()), 1.0F);
  EXPECT_LT(filmic.shown(1.0F), filmic.shown(3.0F));
  EXPECT_LT(filmic.shown(3.0F), 1.0F);
  EXPECT_LT(filmic.shown(0.01F), 0.01F);  // the toe
  EXPECT_GT(filmic.shown(0.18F), 0.18F);  // middle grey gets brighter
  EXPECT_EQ(tone_curve("linear").shown(2.5F), 2.5F);
  EXPECT_THROW(tone_curve("sepia"), std::invalid_argument);
}

TEST(Tone, ExposureMultipliesLightAndLeavesAlpha) {
  ImageF picture(4, 1);
  clear(picture);
  picture.colour[0] = {0.1F, 0.2F, 0.3F, 1.0F};
  picture.colour[1] = {0.1F, 0.2F, 0.3F, 0.5F};
  picture.colour[2] = {-1.0F, std::nanf(""), 0.25F, 0.0F};
  const ToneCurve& linear = tone_curve("linear");
  map_tones(picture, 2.0F, linear);
  EXPECT_EQ(picture.colour[0], (RgbaF{0.2F, 0.4F, 0.6F, 1.0F}));
  EXPECT_EQ(picture.colour[1], (RgbaF{0.2F, 0.4F, 0.6F, 0.5F}));
  EXPECT_EQ(picture.colour[2], (RgbaF{0.0F, 0.0F, 0.5F, 0.0F}));
  EXPECT_EQ(picture.colour[3], RgbaF{});
}

TEST(Tone, HalfCoveredPixelsAreMappedAsTheWholeOnesAre) {
  ImageF picture(2, 1);
  picture.colour[0] = {0.8F, 0.4F, 0.2F, 1.0F};
  picture.colour[1] = {0.2F, 0.1F, 0.05F, 0.25F};
  map_tones(picture, 1.5F, tone_curve("filmic"));
  EXPECT_NEAR(picture.colour[0].r * 0.25F, picture.colour[1].r, 1e-7F);
  EXPECT_NEAR(picture.colour[0].b * 0.25F, picture.colour[1].b, 1e-7F);
}

}  // namespace
}  // namespace delray::image
