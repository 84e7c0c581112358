// How a comparison of compositing schemes is told: as JSON, as text, as a page.
#pragma once

#include <string>
#include <vector>

#include "apps/compare_compose.h"
#include "apps/statistics.h"

namespace delray::apps {

// `delray.compare.compose/1`.
Json comparison_statistics(const CompareRequest& request, const Prepared& prepared,
                           const std::vector<ComparedScheme>& rows);
// For people, on stdout.
void print_comparison(const std::vector<ComparedScheme>& rows);
// The same table as a page of HTML. Throws files::FileError.
void write_comparison(const std::string& path, const CompareRequest& request,
                      const std::vector<ComparedScheme>& rows);

}  // namespace delray::apps
