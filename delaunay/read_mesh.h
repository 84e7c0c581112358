// Triangulations from files, as `verify` needs them: points and simplices, nothing repaired.
#pragma once

#include <filesystem>

#include "delaunay/points.h"
#include "delaunay/triangulation.h"
#include "files/memory_budget.h"

namespace delray::delaunay {

struct PointMesh {
  PointCloud points;
  // Vertex numbers are rows of `points`, in range; their order is the file's. `distinct` and
  // `hull_facets` are not known from a file and stay 0.
  Triangulation triangulation;
};

// Reads PLY, OBJ and OFF (triangles), VTU (triangles or tetrahedra, as written by write_mesh) and
// .node with the .ele beside it (either may be named). A mesh without simplices is legal.
//
// Throws FileError (input) if the file cannot be read or is broken, if a face is no triangle or
// refers to a missing vertex, and for STL, which has no vertex numbers; FileError (memory) if it
// takes more than `memory`. O(bytes).
PointMesh read_mesh(const std::filesystem::path& path, const files::MemoryBudget& memory = {});

}  // namespace delray::delaunay
