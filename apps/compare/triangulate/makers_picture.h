// A triangulation coloured by the threads that made its simplices.
#pragma once

#include <cstdint>
#include <span>

#include "delaunay/points.h"
#include "delaunay/triangulation.h"
#include "image/image.h"

namespace delray::apps {

// A picture of the plane from above, or of space cut through the middle of the points, across
// their shortest extent. Edges are drawn where simplices are large enough. The longer side has
// `side` pixels; what is outside is transparent. Thread t has the hue of a page's series t
// modulo 8. O(simplices + pixels).
//
// REQUIRES: a maker for each simplex; side >= 1.
image::Image8 makers_picture(const delaunay::PointCloud& points,
                             const delaunay::Triangulation& triangulation,
                             std::span<const std::uint16_t> makers, int side);

}  // namespace delray::apps
