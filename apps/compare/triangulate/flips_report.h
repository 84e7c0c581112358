// What methods that insert points one by one do for each of them: flips by kind, and the lists that
// threads keep meanwhile.
#pragma once

#include "apps/compare/triangulate/compare_triangulate.h"
#include "apps/report/html.h"

namespace delray::apps {

// Flips of each method of the most points, with one thread and with the shown number of them.
report::Html flips(const TriangulateComparison& comparison);
// Lengths of journals and of lock lists, of rows that have any; empty without such.
report::Html list_lengths(const TriangulateComparison& comparison);

}  // namespace delray::apps
