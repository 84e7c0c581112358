// The comparison of triangulation methods as a page.
#pragma once

#include <string>

#include "apps/compare/triangulate/compare_distributed.h"
#include "apps/compare/triangulate/compare_triangulate.h"
#include "apps/report/page.h"
#include "apps/session.h"

namespace delray::apps {

// A page about triangulating the points; `what` goes on in its title.
report::Page page_of_triangulations(const Session& session, const TriangulateRequest& request,
                                    const std::string& what);

report::Page triangulate_page(const Session& session, const TriangulateRequest& request,
                              const TriangulateComparison& comparison,
                              const DistributedComparison& simulated);

}  // namespace delray::apps
