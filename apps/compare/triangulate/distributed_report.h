// The comparison of distributed methods as a page.
#pragma once

#include <string>

#include "apps/compare/triangulate/compare_distributed.h"
#include "apps/session.h"

namespace delray::apps {

std::string distributed_report(const Session& session, const TriangulateRequest& request,
                               const DistributedComparison& comparison);

}  // namespace delray::apps
