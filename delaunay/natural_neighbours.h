// The natural neighbours of a place between points.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "delaunay/query.h"

namespace delray::delaunay {

struct NaturalNeighbour {
  std::uint32_t row;
  double weight;
};

// The vertices from whose Voronoi cells a cell of q would take something, with their shares of the
// area (3D: volume) that it would have; they sum to 1 (Sibson 1981). A vertex at q is its only
// neighbour. On the hull the shares are those that they tend to from within: those of the areas
// within a plane of the hull, or of lengths on an edge of it. None outside.
//
// Which neighbours is decided exactly; shares are in floating point, and lose digits where
// simplices are almost flat. The cost of Query::locate, plus O(k^2) for k simplices whose spheres
// hold q.
std::vector<NaturalNeighbour> natural_neighbours(const Query& query, const glm::dvec3& q);

}  // namespace delray::delaunay
