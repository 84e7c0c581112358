// Statistics of triangulations as JSON, alike in `delray triangulate` and `delray compare`.
#pragma once

#include "apps/statistics.h"
#include "delaunay/triangulate.h"

namespace delray::apps {

// Seconds of the phases.
Json phases_json(const delaunay::Statistics& statistics);
Json synchronization_json(const delaunay::Synchronization& synchronization);

}  // namespace delray::apps
