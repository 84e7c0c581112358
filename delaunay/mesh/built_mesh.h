// A mesh as a method leaves it, for those who look at neighbours before they copy simplices out.
#pragma once

#include <cstdint>

#include "delaunay/mesh/array.h"
#include "delaunay/mesh/mesh.h"

namespace delray::delaunay {

// Vertices are numbered along the method's own order, which keeps neighbours near each other. Slots
// may be dead. If all points lie on one line or plane there is no finite simplex.
template <int D>
struct BuiltMesh {
  Mesh<D> mesh;
  Array<std::uint32_t> rows;   // of each vertex of the mesh the row, of equal points the lowest
  std::uint64_t distinct = 0;  // points
};

}  // namespace delray::delaunay
