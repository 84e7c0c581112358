// The identity of a finished picture.
#pragma once

#include <string>

#include "image/image.h"

namespace delray::image {

// XXH3-128 of the RGBA bytes, top row first, as 32 lower-case hex digits, high half first. Depth
// and size do not enter. O(pixels) at memory speed.
std::string hash(const Image8& image);

}  // namespace delray::image
