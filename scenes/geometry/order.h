// An order of triangles and vertices in which neighbours are close together.
#pragma once

#include "scenes/scene.h"

namespace delray::scenes::internal {

// Orders triangles so that those that follow each other, by clusters of 128 and by vectors of 16,
// have small boxes: halved again and again along the longest side of the box of their centres (the
// k-d tree of Bentley 1975). Numbers vertices in the order in which triangles use them. Unless runs
// of triangles are about as compact as they are: renderers take runs of triangles together. Meshes
// of few triangles stay as they are. O(triangles log triangles).
//
// REQUIRES: indices are in range.
void order_for_locality(Mesh& mesh);

}  // namespace delray::scenes::internal
