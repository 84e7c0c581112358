// Fewer points in the same place.
#pragma once

#include "packs/build/surface_error.h"

namespace delray::packs::internal {

struct ThinnedPoints {
  scenes::Mesh mesh;     // ordered for locality
  SurfaceErrors errors;  // by its points; `nearest`, of each of the others, the one it counts for
};

// Some of the points, at most so many and about that, such that all are near to one of them: the
// error of a point is no less than the distance of each that counts for it, with what that was
// moved by before. `expected`, where it is known about, is the largest of these errors and saves
// time; 0: unknown. Expected O(n (1 + n / most)) for points on surfaces. Deterministic.
//
// REQUIRES: the mesh is of points, which have an error before or none has; most >= 1.
ThinnedPoints thin_points(const FineSurface& fine, std::size_t most, float expected = 0);

}  // namespace delray::packs::internal
