// Takes the vertices of the facets that belong to one simplex only: sorted in 3D, and in 2D chained
// from edge to edge.
#include "delaunay/adjacency.h"

#include <algorithm>
#include <unordered_map>

#include "delaunay/write_mesh.h"

namespace delray::delaunay {

std::vector<std::uint32_t> hull_vertices(const Triangulation& triangulation) {
  std::vector<std::uint32_t> facets = hull_facets(triangulation);
  if (facets.empty()) return {};
  if (triangulation.dim == 3) {
    std::ranges::sort(facets);
    facets.erase(std::unique(facets.begin(), facets.end()), facets.end());
    return facets;
  }
  std::unordered_map<std::uint32_t, std::uint32_t> next;
  for (std::size_t i = 0; i < facets.size(); i += 2) next[facets[i]] = facets[i + 1];
  std::vector<std::uint32_t> result = {*std::ranges::min_element(facets)};
  while (next.at(result.back()) != result.front()) result.push_back(next.at(result.back()));
  return result;
}

}  // namespace delray::delaunay
