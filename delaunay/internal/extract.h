// From a mesh to the simplices that users see.
#pragma once

#include <cstdint>
#include <span>

#include "delaunay/mesh.h"
#include "delaunay/triangulation.h"

namespace delray::delaunay::internal {

// The finite live simplices, vertex i replaced by rows[i]. Frees the mesh on the way, so that mesh
// and result are never in memory together as a whole. O(simplices).
Triangulation extract(Mesh<2>&& mesh, std::span<const std::uint32_t> rows);

}  // namespace delray::delaunay::internal
