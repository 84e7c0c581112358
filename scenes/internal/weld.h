// Joining equal vertices.
#pragma once

#include "scenes/scene.h"

namespace delray::scenes::internal {

// Makes one vertex of all vertices whose attributes are equal to the last bit; the first stays
// where it is among those that remain. O(vertices) expected.
void weld(Mesh& mesh);

}  // namespace delray::scenes::internal
