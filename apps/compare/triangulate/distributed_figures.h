// The comparison of distributed methods as JSON and as a table.
#pragma once

#include "apps/compare/triangulate/compare_distributed.h"

namespace delray::apps {

Json distributed_statistics(const TriangulateRequest& request,
                            const DistributedComparison& comparison);
TextTable distributed_table(const DistributedComparison& comparison);

// Over the square root of the points.
double shared_per_root(const ComparedDistributedMethod& row);

}  // namespace delray::apps
