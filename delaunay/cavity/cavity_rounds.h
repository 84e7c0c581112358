// Inserting the points of a 3D triangulation, by one thread or by several.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

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

struct Inserted {
  std::uint64_t distinct = 0;  // points
  // Summed over threads; 0 without options.statistics.
  double locate_seconds = 0, subdivide_seconds = 0;
  // For each slot of the mesh the thread that made its simplex; empty without options.created_by,
  // or if one thread made all.
  std::vector<std::uint16_t> created_by;
};

// Both insert the other vertices. Slots that are not used are dead or dropped. Errors:
// std::bad_alloc, parallel::Interrupted.
Inserted insert_alone(const CavityInput& input, const Options& options);

// With as many threads as options.threads says, in the arena of the caller, without locks: a box
// around the points of a round is cut where it has as many points on one side as on the other, and
// so on, until there is a region for every thread (cavity.h). Points that need simplices
// of several regions wait for a pass with other cuts, and the last of them for one thread.
Inserted insert_in_parallel(const CavityInput& input, const Options& options);

// Makes room for more simplices. Errors: std::bad_alloc.
void grow(Mesh<3>& mesh);

}  // namespace delray::delaunay::internal
