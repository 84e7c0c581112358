// Point sets for trying, testing and measuring triangulations.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "delaunay/points.h"

namespace delray::delaunay {

// An entry of the table of point sets.
struct PointGenerator {
  std::string_view name;         // "gauss"
  std::string_view description;  // one line
  // n points of dimension 2 or 3.
  PointCloud (*generate)(std::size_t n, int dim, std::uint64_t seed);
};

// The six distributions of Kohout (2004), section 7, then sets that are hard for one reason each.
std::span<const PointGenerator> point_generators();

// n points of the named kind, within or close to the unit square or cube unless the description
// says otherwise; z is 0 in the plane, and the cloud says that it has none. Coordinate k of point i
// depends on kind, n, dimension, seed and i only, through a counter-based generator (Philox,
// Salmon et al. 2011), and is computed with the operations that IEEE 754 rounds correctly and with
// no function of libm that differs between machines: the same bytes everywhere and for every number
// of threads. O(n), parallel.
//
// Throws std::invalid_argument, naming the kinds, for any other name, and unless dim is 2 or 3.
PointCloud generate_points(std::string_view kind, std::size_t n, int dim, std::uint64_t seed);

}  // namespace delray::delaunay
