// The last step of loading a scene, alike for all formats.
#pragma once

#include "scenes/files/source.h"
#include "scenes/scene.h"

namespace delray::scenes::internal {

// Drops triangles with two equal indices, meshes without triangles and instances of them, with a
// warning; fails where nothing is left or a transform leaves the range of coordinates. Adds a
// material where there is none.
void finish(const Source& source, Scene& scene);

// Whether two corners are in one place.
bool is_degenerate(const Mesh& mesh, const glm::uvec3& triangle);

}  // namespace delray::scenes::internal
