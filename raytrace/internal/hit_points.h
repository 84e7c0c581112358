// From the hits of a group to the points that are shaded.
#pragma once

#include <span>

#include "raytrace/placement.h"
#include "raytrace/wave.h"

namespace delray::raytrace {

// The answer of a group whose rays were traced: for each lane what intersection() gives, to the
// last bit. Lanes that hit the same placement are computed together by vectors.
void find_points(std::span<const Placement> placements, RayGroup& group);

}  // namespace delray::raytrace
