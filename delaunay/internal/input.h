// A file in memory while it is being read, and how its readers complain.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "files/error.h"

namespace delray::delaunay {

struct Input {
  std::string name;          // as in messages
  std::string_view content;  // the whole file
};

[[noreturn]] inline void fail(const Input& input, std::string place, const std::string& what) {
  throw files::FileError(files::Cause::input, input.name, std::move(place), what);
}

inline std::string at_line(std::size_t line) { return "line " + std::to_string(line); }
inline std::string at_byte(std::size_t byte) { return "byte " + std::to_string(byte); }

}  // namespace delray::delaunay
