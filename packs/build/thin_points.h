// Fewer points in the same place.
#pragma once

#include <span>

#include "packs/build/simplify.h"

namespace delray::packs::internal {

// About kKept of the points, those that were far from others among them. A point that is left out
// counts as moved to one that stays: the error of that one, and so the largest, is no less than the
// distance and what the other was moved by `before`, one value for each point or none. Expected
// O(n) for points on surfaces. Deterministic.
//
// REQUIRES: the mesh is of points.
Simplified thin_points(const scenes::Mesh& mesh, std::span<const float> before = {});

}  // namespace delray::packs::internal
