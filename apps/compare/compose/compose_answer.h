// The first screen of the page that compares compositing schemes: which to use, and why.
#pragma once

#include <string>
#include <vector>

#include "apps/compare/compose/compare_compose.h"
#include "apps/report/html.h"

namespace delray::apps {

// REQUIRES: !comparison.rows.empty().
report::Html compose_answer(const ComposeComparison& comparison);

// Which schemes are not among the many ranks, and why; empty if none.
report::Html omissions(const std::vector<LeftOut>& left_out);

// Codecs and networks of the rows, each once, as they come.
std::vector<std::string> codecs_of(const std::vector<ComparedScheme>& rows);
std::vector<std::string> networks_of(const std::vector<ComparedScheme>& rows);

}  // namespace delray::apps
