// Inserting the points of a 3D triangulation, by one thread or by several.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "delaunay/mesh/mesh.h"
#include "delaunay/order/curve_order_3d.h"
#include "delaunay/predicates/sphere_tests.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay::internal {

// A mesh that grows, and what is known about its points.
struct CavityInput {
  Mesh<3>& mesh;  // its first `used` slots hold a triangulation of the vertices `start`
  SimplexNumber used;
  std::span<const VertexNumber> start;
  CurveOrder3d& order;
  const PointRange& range;
  const SphereTests& tests;
};

// Both insert the other vertices and return how many points are distinct. Slots that are not used
// are dead or dropped. Times are added to `seconds` if it is not null. Errors: std::bad_alloc,
// parallel::Interrupted.
std::uint64_t insert_alone(const CavityInput& input, const Options& options, Statistics* seconds);

// With as many threads as options.threads says, in the arena of the caller, without locks: a box
// around the points of a round is cut where it has as many points on one side as on the other, and
// so on, until there is a region for every thread (cavity.h). Points that need simplices
// of several regions wait for a pass with other cuts, and the last of them for one thread.
std::uint64_t insert_in_parallel(const CavityInput& input, const Options& options,
                                 Statistics* seconds);

// Makes room for more simplices. Errors: std::bad_alloc.
void grow(Mesh<3>& mesh);

}  // namespace delray::delaunay::internal
