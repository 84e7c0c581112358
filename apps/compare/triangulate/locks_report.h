// What methods that lock simplices lock by, beside each other.
#pragma once

#include "apps/compare/triangulate/compare_triangulate.h"
#include "apps/report/html.h"

namespace delray::apps {

// Times and counts of mutexes against atomic instructions (Kohout 2004, Figure 7.9), with the shown
// number of threads; empty without rows of other locks than a method's own.
report::Html lock_kinds(const TriangulateComparison& comparison);
// Likewise, of unlocking simplices before an insertion ends against unlocking them at its end.
report::Html unlock_times(const TriangulateComparison& comparison);

}  // namespace delray::apps
