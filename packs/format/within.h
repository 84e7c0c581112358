// Places in a box.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "geometry/box.h"

namespace delray::packs::internal {

// Whether all are; what is not a number is not. O(places), by vectors.
bool are_within(const geometry::Box3& box, std::span<const glm::vec3> places);

}  // namespace delray::packs::internal
