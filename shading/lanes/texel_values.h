// Codes of texels as the numbers that are filtered.
#pragma once

namespace delray::shading {

// Element c, 0 <= c <= 255: the linear light of code c of an sRGB colour, 0 to 1; of anything else
// (srgb = false), c itself, to be divided by 255 after filtering.
const float* texel_values(bool srgb);

}  // namespace delray::shading
