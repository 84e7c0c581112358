// Facets of a history's leaves that should not be there.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "delaunay/flip/dag.h"
#include "parallel/team.h"

namespace delray::delaunay::internal {

// One corner, of the two, for every facet between leaves of which is_wrong(corner) says so. Looked
// at by so many threads. O(nodes). REQUIRES: no thread inserts.
template <int D, class IsWrong>
std::vector<CornerNumber> wrong_corners(const Dag<D>& dag, std::size_t threads,
                                        IsWrong&& is_wrong) {
  std::vector<std::vector<CornerNumber>> found(threads);
  parallel::Team team;
  team.run(threads, [&](std::size_t thread) {
    const auto end = static_cast<NodeNumber>(std::size_t{dag.size()} * (thread + 1) / threads);
    for (auto node = static_cast<NodeNumber>(std::size_t{dag.size()} * thread / threads);
         node < end; ++node) {
      if (!dag.is_live(node)) continue;
      for (unsigned k = 0; k <= D; ++k) {
        const CornerNumber corner = corner_of(node, k);
        if (corner < dag.neighbour(corner) && is_wrong(corner)) found[thread].push_back(corner);
      }
    }
  });
  for (std::size_t thread = 1; thread < threads; ++thread) {
    found[0].insert(found[0].end(), found[thread].begin(), found[thread].end());
  }
  return std::move(found[0]);
}

}  // namespace delray::delaunay::internal
