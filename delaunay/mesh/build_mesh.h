// The mesh that a method makes, whichever it is.
#pragma once

#include "delaunay/mesh/built_mesh.h"
#include "delaunay/points.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay {

// Of methods that have no mesh to give one is made of their simplices: its ghosts know no neighbour
// but the simplex inside. Errors: see triangulate(); progress is advanced, not started.
template <int D>
BuiltMesh<D> build_mesh(PointView<double> points, const Options& options);

extern template BuiltMesh<2> build_mesh(PointView<double> points, const Options& options);
extern template BuiltMesh<3> build_mesh(PointView<double> points, const Options& options);

// The mesh of simplices whose vertices are numbers below `points`; vertex i is row i. Ghosts know
// no neighbour but the simplex inside. O(simplices). REQUIRES: facets match.
template <int D>
BuiltMesh<D> mesh_of(const Triangulation& triangulation, std::size_t points);

extern template BuiltMesh<2> mesh_of(const Triangulation& triangulation, std::size_t points);
extern template BuiltMesh<3> mesh_of(const Triangulation& triangulation, std::size_t points);

}  // namespace delray::delaunay
