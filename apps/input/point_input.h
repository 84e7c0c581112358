// Points from whatever the user names: files of points, or pictures of elevations.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/input/point_choice.h"
#include "apps/options/input_limits.h"
#include "apps/session.h"
#include "delaunay/points.h"
#include "delaunay/summarize_points.h"
#include "files/coordinate_system.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace delray::apps {

struct PointInput {
  std::string path;                // as messages name the input: the file, or the first of several
  std::vector<std::string> paths;  // files, folders and patterns; none: `path` alone
  PointChoice choice;
  bool terrain_rgb = false;  // heights are coded in the colours of a picture
  double cell_size = 0;      // of an elevation picture; 0: as it says, else such that relief shows
  std::string duplicates;    // empty: first
  InputLimits limits;

  // Whether an option was given that only points have a use for.
  bool given() const {
    return terrain_rgb || cell_size > 0 || !duplicates.empty() || choice.given();
  }
  // Sets `path` by `paths`.
  void name_paths();
  // Whether more than one file may be meant: several, a folder or a pattern.
  bool is_set() const;
};

// Adds an argument (or option) that takes files, folders and patterns, and sets `path` and `paths`.
CLI::Option* add_points_argument(CLI::App& command, const std::string& name, PointInput& input,
                                 const std::string& description);

// Adds --terrain-rgb, --cell-size, --duplicates, --memory and those that choose points.
void add_point_options(CLI::App& command, PointInput& input);

// Whether the points are the pixels of a single picture.
bool is_picture(const PointInput& input);

// The files, folders and patterns as the user named them.
std::vector<std::filesystem::path> named_files(const PointInput& input);
// Says which files of folders are taken for notes beside the points.
void tell_left_out(const PointInput& input);
// Whether the file is a picture.
bool is_picture_file(const std::filesystem::path& path, const files::MemoryBudget& memory);

// What is in the files, read part by part. REQUIRES: none is a picture. Throws FileError and
// UsageError.
delaunay::PointSummary summarize(const PointInput& input);

// Reads the points, whatever they come from. Warnings go to the log. Throws FileError and
// UsageError.
delaunay::PointCloud read_cloud(const PointInput& input);

// Merges places with several heights, with a warning. Throws UsageError.
void merge_places(const PointInput& input, delaunay::PointCloud& cloud);

// Reads the points and merges places with several heights (`dim` 2). Throws FileError and
// UsageError.
delaunay::PointCloud load_points(const PointInput& input, int dim);

// The coordinate system of the points, as their file has it.
files::CoordinateSystem coordinate_system_of(const PointInput& input);

// Throws the UsageError of points without heights in 3D.
[[noreturn]] void refuse_without_z(const PointInput& input);

// Bytes that a point takes while it is read, with all that a file may say of it.
inline constexpr std::uint64_t kMostBytesOfPoint = 40;
// Bytes a point that the default methods take besides the points themselves; measured on uniform
// ones.
inline constexpr std::uint64_t kBytesToTriangulate2D = 70, kBytesToTriangulate3D = 260;
// Throws FileError (memory) unless there is room to triangulate so many points in `dim` dimensions.
void require_memory_to_triangulate(const PointInput& input, std::size_t points, int dim);

}  // namespace delray::apps
