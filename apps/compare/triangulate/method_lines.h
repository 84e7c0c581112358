// How many lines of code each method of triangulation has, counted when the program is built.
#pragma once

#include <span>
#include <string_view>

namespace delray::apps {

// Lines that are neither empty nor comments alone, of the files of `delaunay/` that a method needs,
// mesh and predicates among them; `own` are those of files that sequential insertion does not need.
struct MethodLines {
  std::string_view method;
  int own = 0, all = 0;
};
std::span<const MethodLines> method_lines();

}  // namespace delray::apps
