// The convex hull that a triangulation ends at.
#pragma once

#include <cstdint>
#include <vector>

#include "delaunay/triangulation.h"

namespace delray::delaunay {

// The vertices on the convex hull, those within its edges and faces included. In 2D
// counterclockwise from the lowest row; in 3D ascending. None without simplices. O(n) expected.
//
// The facets themselves are what hull_facets() of write_mesh.h gives.
std::vector<std::uint32_t> hull_vertices(const Triangulation& triangulation);

}  // namespace delray::delaunay
