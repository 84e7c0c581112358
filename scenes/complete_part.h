// Normals of meshes that are made part by part.
#pragma once

#include <cstdint>

#include "scenes/scene.h"

namespace delray::scenes {

// The normals that complete_surfaces gives triangles [first, first + count) of a mesh without
// normals. `part` has, in the order of the mesh, these and all others that have a corner where one
// of them has one. Only these are left, numbered from 0; vertices of the others stay behind
// without a triangle. Parallel.
void complete_part(Mesh& part, std::uint32_t first, std::uint32_t count,
                   float crease_degrees = 60.0F);

}  // namespace delray::scenes
