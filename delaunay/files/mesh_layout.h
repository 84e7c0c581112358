// Mesh files that are a header and arrays of rows of fixed sizes: where each byte lies follows from
// the counts, so that any part can be written at any time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "delaunay/write_mesh.h"

namespace delray::delaunay {

// What a mesh file has.
struct MeshShape {
  std::uint64_t points = 0, simplices = 0;
  int corners = 3;  // of a simplex
  bool has_z = false;
  bool colours = false, intensity = false, classification = false, created_by = false;
};
MeshShape shape_of(const MeshView& mesh);

// Some simplices that follow each other in a file.
struct SimplexRun {
  std::uint64_t first = 0;  // the number of the first of them
  std::span<const std::uint32_t> corners;
  std::span<const std::uint16_t> created_by = {};
};

// An array has a row for each point or for each simplex.
struct MeshArray {
  std::string before;  // what comes before the first row
  std::uint64_t row_bytes = 0;
  // One of both: appends the rows of points [first, last) of a cloud, or those of a run.
  std::function<void(const PointCloud& points, std::size_t first, std::size_t last, std::string&)>
      of_points;
  std::function<void(const SimplexRun& run, std::string&)> of_simplices;
};

struct MeshLayout {
  std::string header;
  std::vector<MeshArray> arrays;
  std::string end;
};

MeshLayout ply_layout(const MeshShape& shape);
MeshLayout vtu_layout(const MeshShape& shape);

// Writes a mesh in memory.
void write_in_layout(const std::filesystem::path& path, const MeshLayout& layout,
                     const MeshView& mesh);

}  // namespace delray::delaunay
