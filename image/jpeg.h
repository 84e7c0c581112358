// Pictures as JPEG in memory, fast enough to be made for every frame of a picture that moves.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "image/image.h"

namespace delray::image {

// The colours as a JPEG (JFIF), over black where they are not opaque; depth is not looked at.
// `quality` is libjpeg's, 1 to 100; colours have half of the resolution of brightness below
// 90. Some 250 million pixels a second. The same bytes for the same picture.
//
// Throws files::FileError (device), naming "jpeg". REQUIRES: 1 <= width, height <= 65500.
std::vector<std::byte> encode_jpeg(const Image8& image, int quality);

}  // namespace delray::image
