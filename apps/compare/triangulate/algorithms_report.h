// The algorithms beside each other: simplicity, scalability and efficiency, and speed-ups by
// processing elements, whether threads of this machine or ranks of the simulated one.
#pragma once

#include "apps/compare/triangulate/compare_distributed.h"
#include "apps/compare/triangulate/compare_triangulate.h"
#include "apps/report/html.h"

namespace delray::apps {

// The numbers of processing elements that are shown.
std::vector<int> shown_elements();

// After Kohout (2004), Figures 7.31 and 7.32, with measured numbers in place of grades. `simulated`
// may be empty.
report::Html algorithms(const TriangulateComparison& comparison,
                        const DistributedComparison& simulated);

}  // namespace delray::apps
