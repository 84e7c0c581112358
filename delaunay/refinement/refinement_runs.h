// The ways to refine, behind the table of refine.h.
#pragma once

#include <cstddef>
#include <string_view>

#include "delaunay/refine.h"
#include "delaunay/refinement/refinement_mesh.h"
#include "delaunay/refinement/triangle_shape.h"

namespace delray::delaunay::internal {

struct RefinementLimits {
  int threads = 1;
  std::size_t most_vertices = 0;
  parallel::Progress* progress = nullptr;
};

// Cuts pieces and triangles of a mesh whose segments are edges and whose domain is known. Throws
// std::length_error, parallel::Interrupted.
using RefinementRun = void (*)(RefinementMesh& mesh, const TriangleBounds& bounds,
                               const RefinementLimits& limits, RefineCounts& counts);

// A run, and what it takes for large.
struct RefinementWay {
  RefinementRun run;
  Measure measure;
};

// Of a name in the table, or "auto". Throws std::invalid_argument, naming the methods.
RefinementWay refinement_way(std::string_view name);

// One thread (Ruppert 1995).
void refine_alone(RefinementMesh& mesh, const TriangleBounds& bounds,
                  const RefinementLimits& limits, RefineCounts& counts);

// Threads with triangles of their own, of which each locks what it reads (Okusanya and Peraire
// 1996).
void refine_with_locks(RefinementMesh& mesh, const TriangleBounds& bounds,
                       const RefinementLimits& limits, RefineCounts& counts);

}  // namespace delray::delaunay::internal
