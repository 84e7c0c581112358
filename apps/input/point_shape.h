// The shape of points: heights over a plane, or all around in space.
#pragma once

#include "delaunay/points.h"

namespace delray::apps {

// Whether points are in space, such as a scan of a statue, rather than heights over x and y, such
// as a terrain: where points close together in x and y differ widely in z. Few points are not.
bool are_in_space(const delaunay::PointCloud& points);

}  // namespace delray::apps
