// What is in files of points, told without holding all of them in memory.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "delaunay/point_filter.h"
#include "delaunay/read_points.h"
#include "geometry/box.h"

namespace delray::delaunay {

// What one file says of itself. Only LAS tells all of it.
struct PointFileFacts {
  std::string file;
  std::string format;               // "LAS", "PLY" as in the table of readers
  std::string version;              // "1.4"
  std::optional<int> point_format;  // 0 to 10
  std::string compression;          // "LAZ", "COPC"
  std::optional<glm::dvec3> scale, offset;
  std::string coordinate_system;  // its name, empty if none is told
  int epsg = 0;                   // its number in the EPSG registry, 0 if none is told
};

// What is in an input of several files.
struct PointSummary {
  std::vector<PointFileFacts> files;       // in the order given
  std::vector<std::uint64_t> file_points;  // of each file
  std::uint64_t points = 0;
  geometry::Box3d box;
  bool has_z = false, geographic = false;
  bool colours = false, intensity = false;  // attributes that points of all files have
  std::optional<std::array<std::uint64_t, 256>> classes;                 // points of each class
  std::optional<std::array<std::array<std::uint64_t, 16>, 16>> returns;  // [number][count]
  std::vector<std::string> warnings;
};

// Reads all points, part by part and in parallel. Memory is that of a few parts. Throws what
// open_points() throws.
PointSummary summarize_points(std::span<const std::filesystem::path> inputs,
                              const PointFilter& filter = {}, const ReadOptions& options = {});

}  // namespace delray::delaunay
