// Whether points without simplices have to be without.
#pragma once

#include "comm/communicator.h"
#include "delaunay/verify/findings.h"
#include "delaunay/verify_pieces.h"

namespace delray::delaunay::internal {

// Collective: whether all points are equal, collinear or, in 3D, coplanar; counts them. Where they
// are not, refuses the mesh. The first rank reads all, as a few points tell.
template <int D>
bool check_flat(comm::Communicator& communicator, const PointParts& points, PiecesVerdict& verdict,
                Findings& findings);

}  // namespace delray::delaunay::internal
