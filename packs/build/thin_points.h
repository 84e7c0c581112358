// Fewer points in the same place.
#pragma once

#include "packs/build/simplify.h"
#include "packs/build/surface_error.h"

namespace delray::packs::internal {

struct ThinnedPoints {
  scenes::Mesh mesh;     // ordered for locality
  SurfaceErrors errors;  // by its points; `nearest`, of each of the others, the one it counts for
};

// About kKept of the points, so far from each other that what they stand for, points of a finer
// level or all of them themselves, is near to one of them: the error of a point is no less than the
// distance of each that counts for it, with what that was moved by before. Expected O(n) for points
// on surfaces. Deterministic.
//
// REQUIRES: both meshes are of points, which have an error before or none has.
ThinnedPoints thin_points(const scenes::Mesh& mesh, const FineSurface& fine);

}  // namespace delray::packs::internal
