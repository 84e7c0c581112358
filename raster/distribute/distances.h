// Distances instead of depths.
#pragma once

#include <span>

#include "geometry/rect.h"
#include "image/image.h"
#include "raster/pipeline/window.h"
#include "scenes/camera.h"

namespace delray::raster {

// Makes distances along the view axis, which are >= 0, of depths, which are less (distance_of);
// empty pixels, and those that have distances already, stay. O(pixels), parallel.
void to_distances(std::span<float> depths, const scenes::View& view);

// The same of the pixels of a window, by the calling thread.
template <class Colour>
void to_distances(const geometry::Rect& rect, const Window<Colour>& window,
                  const scenes::View& view);

}  // namespace delray::raster
