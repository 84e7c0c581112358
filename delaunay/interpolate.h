// Values between points.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "delaunay/query.h"

namespace delray::delaunay {

// The value at q of the function that is linear on every simplex and has values[row] at each
// vertex; none outside the hull. In floating point. The cost of Query::locate.
//
// REQUIRES: a value per row; of equal points that of the lowest row counts.
std::optional<double> interpolate_linear(const Query& query, std::span<const double> values,
                                         const glm::dvec3& q);

// The value at q weighted by the areas that a cell of q would take from the Voronoi cells of its
// neighbours (Sibson 1981): the value itself at a vertex, linear along the hull, smooth everywhere
// but at vertices, and exact for linear functions; none outside the hull. Which neighbours, is
// decided exactly; areas are in floating point, and lose digits where triangles of the hull are
// almost flat. The cost of Query::locate, plus O(k^2) for k neighbours.
//
// REQUIRES: dimension 2; a value per row, as above.
std::optional<double> interpolate_natural_neighbour(const Query& query,
                                                    std::span<const double> values,
                                                    const glm::dvec3& q);

}  // namespace delray::delaunay
