// Statistics of triangulations as JSON, alike in `delray triangulate` and `delray compare`.
#pragma once

#include "apps/statistics.h"
#include "delaunay/triangulate.h"

namespace delray::apps {

// Seconds of the phases.
Json phases_json(const delaunay::Statistics& statistics);
// By the simplices that they replace and make: {"2-2"}, in space {"2-2", "2-3", "3-2", "4-4"}.
Json flips_json(const delaunay::FlipCounts& flips, int dim);
Json synchronization_json(const delaunay::Synchronization& synchronization);
// Threads of the batch method that located points, and since when: [{"inserted", "threads"}].
Json searching_json(const std::vector<delaunay::SearchingThreads>& searching);

}  // namespace delray::apps
