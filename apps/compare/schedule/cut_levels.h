// The height at which Caspary's hierarchy is cut, swept: what every rank has to have of it, what
// travels, and how even the work is.
#pragma once

#include <vector>

#include "apps/compare/schedule/compare_schedule.h"
#include "apps/report/html.h"

namespace delray::apps {

// The distribution whose hierarchy it is.
inline constexpr const char* kCutDistribution = "ray";

// Empty where there are none.
report::Html cut_levels_tab(const std::vector<CutLevel>& levels);
Json cut_levels_json(const std::vector<CutLevel>& levels);

}  // namespace delray::apps
