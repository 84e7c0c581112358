// Making segments edges of a triangulation by cutting them.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "delaunay/refine.h"
#include "delaunay/refinement/refinement_mesh.h"
#include "delaunay/refinement/refinement_runs.h"

namespace delray::delaunay::internal {

// Inserts the middle of each segment that is no edge, until the pieces of all are edges, and marks
// them (Ruppert 1995). Where a vertex lies on a segment, as closely as the mesh's tolerance, the
// segment goes through it; where two cross, both get a vertex. Segments with equal ends are left
// out. From now on what lies between two meetings of segments, or their ends, is a segment.
//
// Throws std::length_error, parallel::Interrupted. REQUIRES: a triangulation of the vertices
// without marks.
void recover_segments(RefinementMesh& mesh, std::span<const SegmentEnds> segments,
                      const RefinementLimits& limits, RefineCounts& counts);

}  // namespace delray::delaunay::internal
