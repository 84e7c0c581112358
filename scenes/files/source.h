// A scene file in memory while it is read.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "files/error.h"
#include "files/file_bytes.h"
#include "files/memory_budget.h"
#include "files/resolve.h"

namespace delray::scenes::internal {

// Coordinates larger than this are refused: products of two would overflow single precision.
inline constexpr double kLargestCoordinate = 1e18;

inline constexpr const char* kNoTriangles =
    "there are no triangles in the file (if it holds points, triangulate them)";

struct Source {
  std::filesystem::path path;
  std::string_view content;
  std::vector<std::string>& warnings;
  files::MemoryBudget memory{};
  files::Outside outside = files::Outside::refused;
  // Whether `content` is all of the file, or nothing, and bytes() reads ranges of it.
  bool whole = true;

  files::FileBytes bytes() const {
    return whole ? files::FileBytes(path.string(), content, memory)
                 : files::FileBytes(path, memory);
  }

  // Every file that the content names, whether it is read or not, from the folder of this one.
  mutable std::vector<std::string> named{};

  void note_named(std::string name) const {
    if (name.empty() || name.find('\0') != std::string::npos) return;
    std::replace(name.begin(), name.end(), '\\', '/');
    named.push_back((path.parent_path() / name).string());
  }
  // The file that the content calls `name`, relative to the folder of this one.
  std::filesystem::path resolve(const std::string& name) const {
    note_named(name);
    return files::resolve(path.parent_path(), name, outside);
  }
  // To be called before so much is allocated for `place`.
  void require_memory(std::uint64_t bytes, const std::string& place = "") const {
    memory.require(bytes, path.string(), place);
  }

  [[noreturn]] void fail(const std::string& place, const std::string& what) const {
    throw files::FileError(files::Cause::input, path.string(), place, what);
  }
  void warn(const std::string& what) const { warnings.push_back(path.string() + ": " + what); }
};

// As Scene::files has them.
inline std::vector<std::string> named_files(const Source& source) {
  std::vector<std::string> files = source.named;
  std::ranges::sort(files);
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

}  // namespace delray::scenes::internal
