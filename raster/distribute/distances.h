// Distances instead of depths.
#pragma once

#include <span>

#include "scenes/camera.h"

namespace delray::raster {

// Makes distances along the view axis of depths (-near / distance); empty pixels, and those that
// have distances already, stay. O(pixels), parallel.
void to_distances(std::span<float> depths, const scenes::View& view);

}  // namespace delray::raster
