// Distances instead of depths.
#pragma once

#include <span>

#include "geometry/rect.h"
#include "image/image.h"
#include "scenes/camera.h"

namespace delray::raster {

// Makes distances along the view axis, which are >= 0, of depths, which are less (distance_of);
// empty pixels, and those that have distances already, stay. O(pixels), parallel.
void to_distances(std::span<float> depths, const scenes::View& view);

// The same of disjoint rectangles of an image.
template <class Colour>
void to_distances(image::BasicImage<Colour>& image, std::span<const geometry::Rect> rects,
                  const scenes::View& view);

}  // namespace delray::raster
