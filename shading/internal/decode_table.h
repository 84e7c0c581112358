// Codes of texels as numbers.
#pragma once

namespace delray::shading {

// Element c, 0 <= c <= 255, is code c of a texture as a number from 0 to 1: linear light of an sRGB
// texture's colours; c / 255 of any other and of alpha.
const float* decode_table(bool srgb);

}  // namespace delray::shading
