// Points from files: one reader for each format, behind one table.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "delaunay/points.h"
#include "files/format.h"

namespace delray::delaunay {

struct Input;

// A way to read points. Every reader checks what a header promises against the size of the file
// before it allocates, and throws FileError (input) with the line, byte or element at fault for
// anything that is not a finite number where one is due.
struct PointReader {
  files::Format format;
  std::string_view name;         // "PLY"
  std::string_view description;  // one line
  std::string_view suffixes;     // ".xyz .csv .txt"
  PointCloud (*read)(const Input& input);
};

std::span<const PointReader> point_readers();

// Options of reading a file of points.
struct ReadOptions {
  // Overrules content and suffix; `unknown` goes by them.
  files::Format format = files::Format::unknown;
  files::MemoryBudget memory{};  // for the file and its points
  // Of points in parts: attributes have the ranges of all points of a file, as read_points() below
  // has them, for which files may be read once more; else of those in its first part.
  bool whole_ranges = false;
};

// Reads the points of a file or stream, row by row as they stand there; of a mesh its vertices. "-"
// is standard input, whose format follows from its content. Numbers in text become the nearest
// double, 32-bit floats are widened, LAS integers become integer * scale + offset, computed in
// double.
//
// Throws FileError (input) if the file cannot be read, is of no known point format, is broken, or
// has no points, FileError (memory) if it is too large. O(bytes), text is parsed in parallel.
PointCloud read_points(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace delray::delaunay
