// Guessing the up axis of files that do not say it.
#pragma once

#include "scenes/scene.h"

namespace delray::scenes::internal {

// True if the scene stands on a flat base at its least z and not on one at its least y, false the
// other way round, otherwise `usual`. A base is flat if triangles that face down in the lowest
// hundredth cover a seventh of the box's footprint. O(triangles).
bool guess_z_up(const Scene& scene, bool usual);

// The area of triangles that lie flat at the low end of y and of z.
struct FlatAreas {
  double y = 0, z = 0;

  FlatAreas operator+(const FlatAreas& b) const { return {y + b.y, z + b.z}; }
};

// Of a scene, or a part of one that is in such a box. O(triangles), parallel.
FlatAreas flat_areas(const Scene& scene, const geometry::Box3& box);
// As the scene of this box and such areas.
bool guess_z_up(const geometry::Box3& box, const FlatAreas& areas, bool usual);

}  // namespace delray::scenes::internal
