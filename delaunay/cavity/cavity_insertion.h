// Incremental insertion in 3D by cavities.
#pragma once

#include "delaunay/mesh/built_mesh.h"
#include "delaunay/points.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay::internal {

// Points in random rounds along a Hilbert curve, each found by a walk from the one before and
// connected to the boundary of its cavity; several threads work in regions of their own
// (cavity_rounds.h). Expected O(n log n) and about 250 bytes a point for points that are spread
// evenly; as many simplices as there are otherwise.
//
// REQUIRES: resolved options, dim 3. Errors: see triangulate().
Result insert_by_cavities(PointView<double> points, const Options& options);
// The mesh before it is copied out.
BuiltMesh<3> mesh_by_cavities(PointView<double> points, const Options& options);

}  // namespace delray::delaunay::internal
