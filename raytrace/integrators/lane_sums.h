// Sums over the lanes of blocks, by vectors.
#pragma once

#include "shading/points.h"

namespace delray::raytrace {

// Adds to the lanes in `mask`.
void add_lanes(const shading::Vectors16& radiance, shading::LaneMask mask,
               shading::Vectors16& sums);

void copy_lanes(const shading::Vectors16& from, shading::LaneMask mask, shading::Vectors16& to);

// The lanes in `mask` of `from`, `otherwise` in all others.
void choose_lanes(const float* from, float otherwise, shading::LaneMask mask,
                  shading::Floats16& to);

void negate_lanes(const shading::Vectors16& from, shading::Vectors16& to);

}  // namespace delray::raytrace
