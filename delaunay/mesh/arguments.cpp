// The checks of simplices, places, attributes and values; the highest vertex is found by a parallel
// reduction.
#include "delaunay/mesh/arguments.h"

#include <algorithm>
#include <cmath>

#include "parallel/parallel_for.h"

namespace delray::delaunay::internal {

void check_simplices(int dim, std::span<const std::uint32_t> vertices, std::size_t rows) {
  check_dim(dim);
  if (vertices.size() % (static_cast<std::size_t>(dim) + 1) != 0) {
    throw std::invalid_argument(std::to_string(vertices.size()) +
                                " vertices do not make whole simplices of " +
                                std::to_string(dim + 1));
  }
  constexpr std::size_t kGrain = 1 << 18;  // vertices: about 0.05 ms
  const std::uint32_t highest = parallel::parallel_reduce(
      0, vertices.size(), kGrain, std::uint32_t{0},
      [&](std::size_t first, std::size_t last) {
        return *std::max_element(vertices.begin() + static_cast<std::ptrdiff_t>(first),
                                 vertices.begin() + static_cast<std::ptrdiff_t>(last));
      },
      [](std::uint32_t a, std::uint32_t b) { return std::max(a, b); });
  if (!vertices.empty() && highest >= rows) {
    throw std::invalid_argument("vertex " + std::to_string(highest) + " is no row of " +
                                std::to_string(rows));
  }
}

void check_place(const glm::dvec3& place) {
  if (!std::isfinite(place.x) || !std::isfinite(place.y) || !std::isfinite(place.z))
    throw std::invalid_argument("a place has a coordinate that is not finite");
}

void check_attributes(const PointCloud& points) {
  for (const std::size_t size :
       {points.colours.size(), points.intensity.size(), points.classification.size()}) {
    if (size != 0 && size != points.size()) {
      throw std::invalid_argument(std::to_string(size) + " attributes for " +
                                  std::to_string(points.size()) + " points");
    }
  }
}

void check_values(std::size_t values, std::size_t rows) {
  if (values < rows) {
    throw std::invalid_argument(std::to_string(values) + " values are too few for " +
                                std::to_string(rows) + " rows");
  }
}

}  // namespace delray::delaunay::internal
