// The ways to refine, behind the table of refine.h.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "comm/communicator.h"
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

// Collective: the mesh is that of rank 0, as are the counts of ranks. Counts are sums. Throws on
// all ranks.
using RefinementRunOverRanks = std::vector<RefineRank> (*)(comm::Communicator& communicator,
                                                           RefinementMesh& mesh,
                                                           const TriangleBounds& bounds,
                                                           const RefinementLimits& limits,
                                                           RefineCounts& counts);

// A run, what it takes for large, and how ranks do it, if they can.
struct RefinementWay {
  RefinementRun run;
  Measure measure;
  RefinementRunOverRanks run_over_ranks = nullptr;
};

// Of a name in the table, or "auto". Throws std::invalid_argument, naming the methods.
RefinementWay refinement_way(std::string_view name, bool over_ranks = false);

// The text of std::length_error.
inline std::string too_many_points(std::size_t most) {
  return "refinement takes more than " + std::to_string(most) + " points";
}

// One thread (Ruppert 1995).
void refine_alone(RefinementMesh& mesh, const TriangleBounds& bounds,
                  const RefinementLimits& limits, RefineCounts& counts);

// So, but ends when there are so many triangles.
void refine_alone_until(RefinementMesh& mesh, const TriangleBounds& bounds,
                        const RefinementLimits& limits, SimplexNumber triangles,
                        RefineCounts& counts);

// Threads with triangles of their own, of which each locks what it reads (Okusanya and Peraire
// 1996).
void refine_with_locks(RefinementMesh& mesh, const TriangleBounds& bounds,
                       const RefinementLimits& limits, RefineCounts& counts);

// Ranks with triangles of their own, which ask others for those that they lack.
std::vector<RefineRank> refine_over_ranks(comm::Communicator& communicator, RefinementMesh& mesh,
                                          const TriangleBounds& bounds,
                                          const RefinementLimits& limits, RefineCounts& counts);

}  // namespace delray::delaunay::internal
