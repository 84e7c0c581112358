// A file in memory while it is being read, and how its readers complain.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "files/error.h"
#include "files/memory_budget.h"

namespace delray::delaunay {

struct Input {
  std::string name;          // as in messages
  std::string_view content;  // the whole file
  files::MemoryBudget memory{};

  // To be called before memory is allocated for so many points, or so many bytes.
  void require_points(std::uint64_t count) const {
    constexpr std::uint64_t kBytesPerPoint = 40;  // a PointCloud with everything
    memory.require(count * kBytesPerPoint, name);
  }
  void require_memory(std::uint64_t bytes) const { memory.require(bytes, name); }
};

[[noreturn]] inline void fail(const Input& input, std::string place, const std::string& what) {
  throw files::FileError(files::Cause::input, input.name, std::move(place), what);
}

// A warning of PointCloud.
inline std::string edges_left_out(std::size_t edges) {
  return std::to_string(edges) + (edges == 1 ? " edge" : " edges") +
         " between points left out: triangulations keep none";
}

inline std::string at_line(std::size_t line) { return "line " + std::to_string(line); }
inline std::string at_byte(std::size_t byte) { return "byte " + std::to_string(byte); }

}  // namespace delray::delaunay
