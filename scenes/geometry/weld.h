// Joining equal vertices.
#pragma once

#include "scenes/scene.h"

namespace delray::scenes::internal {

// Makes one vertex of all vertices whose attributes are equal to the last bit; the first stays
// where it is among those that remain. Returns the new number of each vertex. O(vertices) expected.
std::vector<std::uint32_t> weld(Mesh& mesh);

}  // namespace delray::scenes::internal
