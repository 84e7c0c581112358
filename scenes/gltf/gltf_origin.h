// The origin of a glTF scene, and its instances relative to it.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "scenes/files/source.h"
#include "scenes/scene.h"

namespace delray::scenes::internal {

// Whether place_instances chooses an origin, where the vertices of mesh i lie in boxes[i].
// O(instances).
bool is_far(const Scene& scene, std::span<const glm::dmat4> worlds,
            std::span<const geometry::Box3d> boxes);

// Gives instance i the transform worlds[i] and, where the scene, a node or the vertices of a mesh
// are far from 0 for the size of the scene, chooses Scene::origin and puts the vertices of every
// mesh relative to its own middle: all sums of large numbers are then made here, in double
// precision. Else transforms are rounded as they are, and the origin is 0. Warns where vertices are
// coarse. Returns what the vertices of each mesh are relative to. O(vertices).
std::vector<glm::dvec3> place_instances(const Source& source, std::span<const glm::dmat4> worlds,
                                        Scene& scene);

}  // namespace delray::scenes::internal
