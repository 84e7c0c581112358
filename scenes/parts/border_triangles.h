// Triangles of other ranks around the vertices of a rank's part of a mesh.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "comm/communicator.h"
#include "scenes/scene.h"

namespace delray::scenes::internal {

struct BorderTriangle {
  std::uint64_t number = 0;  // in the whole mesh
  glm::vec3 corners[3];
};

// The triangles of other ranks that have a corner where this rank's mesh has a vertex, ascending.
// Ranks have ascending runs of triangles of one mesh, the first of this rank's being number
// `first`. Collective: a position and back 8 bytes for each vertex, and 48 bytes for each triangle
// at a border. O(vertices log vertices).
std::vector<BorderTriangle> border_triangles(comm::Communicator& communicator, const Mesh& mesh,
                                             std::uint64_t first);

}  // namespace delray::scenes::internal
