// Counts connected components by depth-first search over neighbours with the same creator.
#include "delaunay/adjacency.h"

#include <cassert>
#include <vector>

namespace delray::delaunay {

std::uint64_t count_fragments(const Triangulation& triangulation,
                              std::span<const std::uint16_t> created_by, std::size_t rows) {
  assert(created_by.size() == triangulation.size());
  const Adjacency beside = adjacency(triangulation, rows);
  const auto corners = static_cast<std::size_t>(triangulation.dim) + 1;
  std::uint64_t fragments = 0;
  std::vector<bool> seen(created_by.size(), false);
  std::vector<std::uint32_t> open;
  for (std::uint32_t start = 0; start < created_by.size(); ++start) {
    if (seen[start]) continue;
    ++fragments;
    seen[start] = true;
    open.push_back(start);
    while (!open.empty()) {
      const std::size_t simplex = open.back();
      open.pop_back();
      for (std::size_t k = 0; k < corners; ++k) {
        const std::uint32_t next = beside.neighbours[corners * simplex + k];
        if (next == Adjacency::kNone || seen[next] || created_by[next] != created_by[start])
          continue;
        seen[next] = true;
        open.push_back(next);
      }
    }
  }
  return fragments;
}

}  // namespace delray::delaunay
