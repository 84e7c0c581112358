// From the hits of a group to the points that are shaded.
#pragma once

#include <span>

#include "raytrace/scene/geometry_instance.h"
#include "raytrace/scene/ray_batch.h"

namespace delray::raytrace {

// The answer of a group whose rays were traced: for each lane what intersection() gives, to the
// last bit. Their corners are gathered one lane after the other, the rest is done by vectors.
void find_points(std::span<const GeometryInstance> instances, RayGroup& group);

// Neighbouring hits in a large scene lie far apart in memory. Who has something else to do before
// find_points() calls these first, one after the other, with some time in between: they fetch the
// corners' numbers of the triangles that were hit, then what is known of those vertices.
void fetch_corners(std::span<const GeometryInstance> instances, const RayGroup& group);
void fetch_vertices(std::span<const GeometryInstance> instances, const RayGroup& group);

}  // namespace delray::raytrace
