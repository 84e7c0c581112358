// The end of a refinement.
#pragma once

#include "delaunay/refinement/refinement_mesh.h"

namespace delray::delaunay::internal {

// Whatever pieces are left that could not be cut: the result is the triangulation of its points.
void make_delaunay(RefinementMesh& mesh);

}  // namespace delray::delaunay::internal
