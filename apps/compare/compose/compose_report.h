// The comparison of compositing schemes as a page.
#pragma once

#include <string>

#include "apps/compare/compose/compare_compose.h"
#include "apps/session.h"

namespace delray::apps {

std::string compose_report(const Session& session, const CompareRequest& request,
                           const Prepared& prepared, const ComposeComparison& comparison);

}  // namespace delray::apps
