// From a mesh to the simplices that users see.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "delaunay/mesh/mesh.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay::internal {

// The finite live simplices, vertex i replaced by rows[i]. Frees the mesh on the way, so that mesh
// and result are never in memory together as a whole. O(simplices). Several threads are those of
// the arena that the caller is in; the result does not depend on them.
//
// `created_by` has a value for every slot of the mesh, and those of the simplices are returned in
// their order; empty stays empty.
template <int D>
Result extract(Mesh<D>&& mesh, std::span<const std::uint32_t> rows, int threads = 1,
               std::vector<std::uint16_t> created_by = {});

}  // namespace delray::delaunay::internal
