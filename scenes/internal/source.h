// A scene file in memory while it is read.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "files/error.h"

namespace delray::scenes::internal {

// Coordinates larger than this are refused: products of two would overflow single precision.
inline constexpr double kLargestCoordinate = 1e18;

inline constexpr const char* kNoTriangles =
    "there are no triangles in the file (if it holds points, triangulate them)";

struct Source {
  std::filesystem::path path;
  std::string_view content;
  std::vector<std::string>& warnings;

  [[noreturn]] void fail(const std::string& place, const std::string& what) const {
    throw files::FileError(files::Cause::input, path.string(), place, what);
  }
  void warn(const std::string& what) const { warnings.push_back(path.string() + ": " + what); }
};

}  // namespace delray::scenes::internal
