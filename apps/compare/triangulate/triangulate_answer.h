// The first screen of the page that compares triangulations: which way to take here, and why.
#pragma once

#include "apps/compare/triangulate/compare_triangulate.h"
#include "apps/report/html.h"

namespace delray::apps {

// REQUIRES: !comparison.rows.empty().
report::Html triangulate_answer(const TriangulateComparison& comparison);

}  // namespace delray::apps
