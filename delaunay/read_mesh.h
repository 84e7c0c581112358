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
  bool has_float_coordinates = false;  // the file's are of 32 bits, as always in STL
};

// Reads PLY, OBJ, OFF and STL (triangles; corners of STL that are at one place are one vertex), VTU
// (triangles or tetrahedra, as written by write_mesh) and .node with the .ele beside it (either may
// be named). A mesh without simplices is legal.
//
// Throws FileError (input) if the file cannot be read or is broken, and if a face is no triangle or
// refers to a missing vertex; FileError (memory) if it takes more than `memory`. O(bytes).
PointMesh read_mesh(const std::filesystem::path& path, const files::MemoryBudget& memory = {});

}  // namespace delray::delaunay
