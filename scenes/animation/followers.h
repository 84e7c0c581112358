// What hangs on nodes.
#pragma once

#include <glm/glm.hpp>

#include "scenes/scene.h"

namespace delray::scenes::internal {

// From the node to its parent. Rotations of length 0 are left out.
glm::dmat4 transform_of(const AnimatedNode& node);

// The transform of an instance at a node, of a mesh that is relative to `centre`, in a scene that
// is relative to `origin`.
glm::mat4x3 placed_at(const glm::dmat4& world, const glm::dvec3& centre, const glm::dvec3& origin);

// Moves a light or camera to where a node is in the scene; glTF has both look along -z. Whether
// that changes it.
bool follow(const glm::dmat4& world, Light& light);
bool follow(const glm::dmat4& world, Camera& camera);

}  // namespace delray::scenes::internal
