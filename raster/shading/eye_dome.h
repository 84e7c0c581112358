// Eye-dome lighting: shape from depths alone, where there are no normals.
#pragma once

#include "image/image.h"
#include "scenes/camera.h"

namespace delray::raster {

// Darkens every pixel by how far its neighbours stand before it (Boucheny 2009). Depths are
// distances along the axis of `view`, whose frame is the picture's; they stay. O(pixels), parallel.
template <class Colour>
void light_by_eye_dome(const scenes::View& view, image::BasicImage<Colour>& image);

}  // namespace delray::raster
