// Points to files: one writer for each format, behind one table.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "delaunay/points.h"

namespace delray::delaunay {

// An entry of the table of point formats that are written.
struct PointWriter {
  std::string_view name;         // "CSV"
  std::string_view description;  // one line
  std::string_view suffixes;     // ".xyz .txt"
  void (*write)(const std::filesystem::path& path, const PointCloud& points);
};

std::span<const PointWriter> point_writers();

// The writer for the suffix of `path`. Throws std::invalid_argument, naming the legal suffixes, for
// any other.
const PointWriter& point_writer_for(const std::filesystem::path& path);

// Writes points in the format that the suffix of `path` names; "-" is standard output, as XYZ.
// Coordinates read back equal, in the plane too, but for OBJ and OFF, where every point has a z.
// The file appears whole or not at all.
//
// Throws std::invalid_argument for an unknown suffix, FileError (device) if writing fails. O(n),
// formatted in parallel.
void write_points(const std::filesystem::path& path, const PointCloud& points);

}  // namespace delray::delaunay
