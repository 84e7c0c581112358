// Values between points, and the natural neighbours of a place between them.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "delaunay/query.h"

namespace delray::delaunay {

// The value at q of the function that is linear on every simplex and has values[row] at each
// vertex; none outside the hull. In floating point. The cost of Query::locate.
//
// Throws std::invalid_argument for fewer values than rows; of equal points that of the lowest row
// counts.
std::optional<double> interpolate_linear(const Query& query, std::span<const double> values,
                                         const glm::dvec3& q);

// A vertex and its share.
struct NaturalNeighbour {
  std::uint32_t row;
  double weight;
};

// The vertices from whose Voronoi cells a cell of q would take something, with their shares of the
// area (3D: volume) that it would have; they sum to 1 (Sibson 1981). A vertex at q is its only
// neighbour. On the hull the shares are those that they tend to from within: those of the areas
// within a plane of the hull, or of lengths on an edge of it. None outside.
//
// Which neighbours is decided exactly. Shares are never negative; their errors, added up, are at
// most 3e-10, so that linear functions are off by less than that part of their range among the
// neighbours, for all finite points: in doubles where a bound of the error says so, in wider
// numbers else. The cost of Query::locate, plus O(k log k) for k simplices whose spheres hold q;
// some ten times that on lattices that rounding has bent, a hundred on faces of a hull in space.
std::vector<NaturalNeighbour> natural_neighbours(const Query& query, const glm::dvec3& q);

// The value at q weighted by the shares of its natural neighbours (Sibson 1981): the value itself
// at a vertex, linear along edges of the hull, smooth everywhere but at vertices, and exact for
// linear functions; none outside the hull. The cost and the precision of natural_neighbours().
//
// Values as above.
std::optional<double> interpolate_natural_neighbour(const Query& query,
                                                    std::span<const double> values,
                                                    const glm::dvec3& q);

}  // namespace delray::delaunay
