// Neighbours come from matching facets by their vertices; the star of a vertex is searched breadth
// first over the facets that have it.
#include "delaunay/adjacency.h"

#include <algorithm>
#include <unordered_set>

#include "delaunay/mesh/arguments.h"
#include "delaunay/mesh/facets.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay {

Adjacency adjacency(const Triangulation& triangulation, std::size_t rows) {
  internal::check_triangulation(triangulation, rows);
  const auto corners = static_cast<std::uint32_t>(triangulation.dim + 1);
  Adjacency result;
  result.neighbours = match_facets(triangulation.dim, triangulation.vertices, rows).mates;
  constexpr std::size_t kGrain = 65536;  // corners: about 0.1 ms
  parallel::parallel_for(0, result.neighbours.size(), kGrain, [&](std::size_t i) {
    std::uint32_t& mate = result.neighbours[i];
    if (mate != FacetMates::kNone) mate /= corners;
  });
  result.simplex_at.assign(rows, Adjacency::kNone);
  for (std::size_t i = triangulation.vertices.size(); i-- > 0;) {
    result.simplex_at[triangulation.vertices[i]] = static_cast<std::uint32_t>(i / corners);
  }
  return result;
}

std::vector<std::uint32_t> simplices_around(const Triangulation& triangulation,
                                            const Adjacency& adjacency, std::uint32_t row) {
  if (row >= adjacency.simplex_at.size())
    throw std::invalid_argument("row " + std::to_string(row) + " does not exist");
  if (adjacency.neighbours.size() != triangulation.vertices.size())
    throw std::invalid_argument("the adjacency is of another triangulation");
  std::vector<std::uint32_t> star;
  if (adjacency.simplex_at[row] == Adjacency::kNone) return star;
  const auto corners = static_cast<std::size_t>(triangulation.dim) + 1;
  star.push_back(adjacency.simplex_at[row]);
  // Stars are small as a rule, and then looking through them is faster than a set.
  constexpr std::size_t kSmall = 64;
  std::unordered_set<std::uint32_t> known;
  const auto is_known = [&](std::uint32_t simplex) {
    if (star.size() <= kSmall) return std::ranges::find(star, simplex) != star.end();
    if (known.empty()) known.insert(star.begin(), star.end());
    return !known.insert(simplex).second;
  };
  for (std::size_t i = 0; i < star.size(); ++i) {
    for (std::size_t k = 0; k < corners; ++k) {
      const std::size_t corner = star[i] * corners + k;
      const std::uint32_t next = adjacency.neighbours[corner];
      if (triangulation.vertices[corner] == row || next == Adjacency::kNone) continue;
      if (!is_known(next)) star.push_back(next);
    }
  }
  return star;
}

std::vector<std::uint32_t> vertices_around(const Triangulation& triangulation,
                                           const Adjacency& adjacency, std::uint32_t row) {
  const auto corners = static_cast<std::size_t>(triangulation.dim) + 1;
  std::vector<std::uint32_t> result;
  for (const std::uint32_t simplex : simplices_around(triangulation, adjacency, row)) {
    for (std::size_t k = 0; k < corners; ++k) {
      const std::uint32_t vertex = triangulation.vertices[simplex * corners + k];
      if (vertex != row) result.push_back(vertex);
    }
  }
  std::ranges::sort(result);
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

}  // namespace delray::delaunay
