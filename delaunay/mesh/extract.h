// From a mesh to the simplices that users see.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "delaunay/mesh/mesh.h"
#include "delaunay/triangulation.h"

namespace delray::delaunay::internal {

// The finite live simplices, vertex i replaced by rows[i]. Frees the mesh on the way, so that mesh
// and result are never in memory together as a whole. O(simplices). Several threads are those of
// the arena that the caller is in; the result does not depend on them.
//
// `created_by`, if not null, has a value for every slot of the mesh and keeps those of the result's
// simplices, in their order.
template <int D>
Triangulation extract(Mesh<D>&& mesh, std::span<const std::uint32_t> rows, int threads = 1,
                      std::vector<std::uint16_t>* created_by = nullptr);

}  // namespace delray::delaunay::internal
