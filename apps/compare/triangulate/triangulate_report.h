// The comparison of triangulation methods as a page.
#pragma once

#include <string>

#include "apps/compare/triangulate/compare_triangulate.h"
#include "apps/session.h"

namespace delray::apps {

std::string triangulate_report(const Session& session, const TriangulateRequest& request,
                               const TriangulateComparison& comparison);

}  // namespace delray::apps
