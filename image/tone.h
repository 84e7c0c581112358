// From light to what a screen can show: exposure and tone curves, for output of 8 bits.
#pragma once

#include <span>
#include <string_view>

#include "image/image.h"

namespace delray::image {

// An entry of the table of curves from linear light to what a screen shows.
struct ToneCurve {
  const char* name;
  const char* description;
  // The curve for a channel of linear light; never falls, 0 at 0. REQUIRES: light >= 0, not NaN.
  float (*shown)(float light);
};

// linear, filmic. The first is the default.
std::span<const ToneCurve> tone_curves();

// Throws std::invalid_argument that lists the names for any other.
const ToneCurve& tone_curve(std::string_view name);

// Each channel times `factor`, then through the curve, in place; premultiplied colours are taken as
// what they are without alpha. Channels that are negative or NaN become 0. Parallel; O(pixels).
void map_tones(ImageF& picture, float factor, const ToneCurve& curve);

}  // namespace delray::image
