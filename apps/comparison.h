// How a comparison of compositing schemes is told: as JSON and as text.
#pragma once

#include <string>
#include <vector>

#include "apps/compare_compose.h"
#include "apps/statistics.h"

namespace delray::apps {

// `delray.compare.compose/1`.
Json comparison_statistics(const CompareRequest& request, const Prepared& prepared,
                           const ComposeComparison& comparison);
// A heading and a line for each row, with a column for each network that any row has.
std::vector<std::vector<std::string>> comparison_table(const std::vector<ComparedScheme>& rows);
// For people, on stdout.
void print_comparison(const std::vector<ComparedScheme>& rows);

}  // namespace delray::apps
