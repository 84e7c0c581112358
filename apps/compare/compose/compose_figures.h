// The results of a comparison of compositing schemes, as JSON and as text.
#pragma once

#include <string>
#include <vector>

#include "apps/compare/compose/compare_compose.h"
#include "apps/statistics.h"

namespace delray::apps {

// `delray.compare.compose/1`.
Json compose_statistics(const CompareRequest& request, const Prepared& prepared,
                        const ComposeComparison& comparison);
// A heading and a line for each row, with a column for each network that any row has.
TextTable compose_table(const std::vector<ComparedScheme>& rows);

}  // namespace delray::apps
