// Triangulations to files: one writer for each format, behind one table.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "delaunay/points.h"
#include "delaunay/triangulation.h"
#include "files/format.h"

namespace delray::delaunay {

// Input of a writer: `corners` vertices per simplex, which are rows of `points`.
struct MeshView {
  const PointCloud& points;
  int corners = 3;
  std::span<const std::uint32_t> simplices;
  std::span<const std::uint16_t> created_by = {};  // one per simplex, or none

  std::size_t size() const { return simplices.size() / static_cast<std::size_t>(corners); }
};

struct MeshShape;
struct MeshLayout;

// An entry of the table of mesh formats that are written.
struct MeshWriter {
  files::Format format;
  std::string_view name;         // "PLY"
  std::string_view description;  // one line
  std::string_view suffixes;     // ".node .ele"
  bool tetrahedra;               // otherwise a tetrahedral mesh is written as its hull
  void (*write)(const std::filesystem::path& path, const MeshView& mesh);
  // Where each byte lies, for meshes that are written in parts; null where that does not follow
  // from counts.
  MeshLayout (*layout)(const MeshShape& shape) = nullptr;
};

std::span<const MeshWriter> mesh_writers();

// The writer for the suffix of `path`. Throws std::invalid_argument, naming the legal suffixes, for
// any other.
const MeshWriter& mesh_writer_for(const std::filesystem::path& path);

// Writes points and simplices in the format that the suffix of `path` names; "-" is standard
// output, as PLY. Every row of `points` is a vertex of the file, used or not, so that vertex
// numbers are rows. Coordinates read back equal, but for STL, which has 32-bit floats. Colours go
// to PLY and VTU, intensity and class to VTU. The file appears whole or not at all. `created_by`,
// the threads that made the simplices (Result::created_by), go to VTU as the cells' "thread";
// other formats leave them out.
//
// Throws std::invalid_argument for an unknown suffix, for vertices that are no rows of points, for
// attributes or created_by of which there are not as many as points or simplices, FileError
// (device) if writing fails. O(n), formatted in parallel.
void write_mesh(const std::filesystem::path& path, const PointCloud& points,
                const Triangulation& triangulation, std::span<const std::uint16_t> created_by = {});

// The facets that belong to one simplex only: edges (2D, counterclockwise) or triangles (3D,
// counterclockwise from outside), dim vertices each, in the order of their simplices. O(n).
std::vector<std::uint32_t> hull_facets(const Triangulation& triangulation);

}  // namespace delray::delaunay
