// An order of triangles and vertices in which neighbours are close together.
#pragma once

#include "scenes/scene.h"

namespace delray::scenes::internal {

// Sorts triangles along a Z-order curve (Morton 1966) through their centres, and numbers vertices
// in the order in which triangles use them, unless runs of triangles are about as compact as they
// are: renderers take runs of triangles together. Meshes of few triangles stay as they are.
// O(triangles log triangles).
//
// REQUIRES: indices are in range.
void order_for_locality(Mesh& mesh);

}  // namespace delray::scenes::internal
