// Triangulations from files, as `verify` needs them: points and simplices, nothing repaired.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "delaunay/points.h"
#include "delaunay/triangulation.h"
#include "files/format.h"
#include "files/memory_budget.h"

namespace delray::delaunay {

// A mesh as its file has it.
struct PointMesh {
  PointCloud points;
  // Vertex numbers are rows of `points`, in range; their order is the file's. `distinct` and
  // `hull_facets` are not known from a file and stay 0.
  Triangulation triangulation;
  bool has_float_coordinates = false;  // the file's are of 32 bits, as always in STL
};

// A way to read meshes.
struct MeshReader {
  files::Format format;
  std::string_view name;         // "PLY"
  std::string_view description;  // one line
  PointMesh (*read)(const std::filesystem::path& path, const files::MemoryBudget& memory);
};

std::span<const MeshReader> mesh_readers();

// Reads what mesh_readers() lists, and folders of pieces (mesh_folder.h); of .node and .ele, which
// lie beside each other, either may be named. Corners of STL that are at one place are one vertex.
// A mesh without simplices is legal.
//
// Throws FileError (input) if the file cannot be read or is broken, and if a face is no triangle or
// refers to a missing vertex; FileError (memory) if it takes more than `memory`. O(bytes).
PointMesh read_mesh(const std::filesystem::path& path, const files::MemoryBudget& memory = {});

}  // namespace delray::delaunay
