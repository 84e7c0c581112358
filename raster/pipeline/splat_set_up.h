// A cluster of points or segments as fragments and splats on the screen.
#pragma once

#include "raster/pipeline/cluster_set_up.h"
#include "raster/pipeline/transform.h"

namespace delray::raster {

// Appends what may be seen of the cluster's splats within `clip`, and counts them: small ones as
// spots in windows or pixels of theirs as fragments, others with their entries in tiles. `vertices`
// is memory.
void set_up_splats(const ClusterToSetUp& cluster, ScreenVertices& vertices, SetUpResult& result);

}  // namespace delray::raster
