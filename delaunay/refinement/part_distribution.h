// A mesh of rank 0 cut into parts for all ranks, and put together again.
#pragma once

#include "comm/communicator.h"
#include "delaunay/refinement/mesh_part.h"
#include "delaunay/refinement/triangle_shape.h"

namespace delray::delaunay::internal {

// Collective: the triangles along a Hilbert curve, in runs of about as many as there will be by the
// bound of area. `mesh` is rank 0's and empty then. Copies of triangles across pieces of segments
// are here. Parts may be empty.
MeshPart distribute_parts(comm::Communicator& communicator, RefinementMesh& mesh,
                          const TriangleBounds& bounds);

// Collective: the triangles of all parts by ascending rank, in the `mesh` of rank 0. Given vertices
// have the numbers that they had, others follow by ascending rank.
void gather_parts(comm::Communicator& communicator, MeshPart& part, RefinementMesh& mesh);

}  // namespace delray::delaunay::internal
