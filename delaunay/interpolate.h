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
// Throws std::invalid_argument for fewer values than rows; of equal points that of the lowest row
// counts.
std::optional<double> interpolate_linear(const Query& query, std::span<const double> values,
                                         const glm::dvec3& q);

// The value at q weighted by the shares of its natural neighbours (Sibson 1981): the value itself
// at a vertex, linear along edges of the hull, smooth everywhere but at vertices, and exact for
// linear functions; none outside the hull. The cost and the precision of natural_neighbours().
//
// Values as above.
std::optional<double> interpolate_natural_neighbour(const Query& query,
                                                    std::span<const double> values,
                                                    const glm::dvec3& q);

}  // namespace delray::delaunay
