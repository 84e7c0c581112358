// Points in space in the order in which a cavity kernel takes them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "delaunay/mesh/array.h"
#include "delaunay/points.h"
#include "delaunay/predicates/sphere_tests.h"

namespace delray::delaunay::internal {

// A point, and what a kernel notes about it, in half a cache line.
struct alignas(32) SpaceVertex {
  glm::dvec3 position;
  std::uint32_t row;    // of the input; of equal points the lowest
  std::uint32_t local;  // the kernel's own
};
static_assert(sizeof(SpaceVertex) == 32);

// Vertex v lies at vertices[v + 1]: the infinite vertex, whose number plus 1 is 0, has a place of
// its own there.
struct CurveOrder3d {
  Array<SpaceVertex> vertices;
  std::vector<std::uint32_t> rounds;  // where the rounds begin, and the number of points
};

// The range of points that SphereTests need. Errors: std::invalid_argument that names the first row
// with a coordinate that is not finite.
PointRange finite_range(const PointView<double>& points, int threads = 1);

// Random rounds of growing size, each along a Hilbert curve (Amenta, Choi and Rote 2003): radix
// sort, O(n). With -0 made 0.
CurveOrder3d curve_order_3d(const PointView<double>& points, const PointRange& range,
                            std::uint64_t seed, int threads = 1);

}  // namespace delray::delaunay::internal
