// The queue and the threads of the batch method.
#pragma once

#include "apps/compare/triangulate/compare_triangulate.h"
#include "apps/report/html.h"

namespace delray::apps {

// Capacities of queues against time (Kohout 2004, Figure 7.6); empty where there are none.
report::Html queues(const TriangulateComparison& comparison);
// Time with given numbers of threads that locate points and with those that the method chooses, and
// what it chose when (7.8.1); empty without rows of the method and three threads.
report::Html searching_threads(const TriangulateComparison& comparison);

}  // namespace delray::apps
