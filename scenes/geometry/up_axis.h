// Guessing the up axis of files that do not say it.
#pragma once

#include "scenes/scene.h"

namespace delray::scenes::internal {

// True if the scene stands on a flat base at its least z and not on one at its least y, false the
// other way round, otherwise `usual`. A base is flat if triangles that face down in the lowest
// hundredth cover a seventh of the box's footprint. O(triangles).
bool guess_z_up(const Scene& scene, bool usual);

}  // namespace delray::scenes::internal
