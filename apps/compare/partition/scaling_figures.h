// How strategies scale, as JSON and as a tab of the page.
#pragma once

#include "apps/compare/partition/strategy_scaling.h"
#include "apps/report/html.h"
#include "apps/statistics.h"

namespace delray::apps {

// Rows by strategy and ranks with what each network foretells of frames at rest and turning, and
// for each strategy and network where it stops gaining.
Json scaling_json(const StrategyScaling& scaling);

// "Beyond this machine". REQUIRES: there are rows.
report::Html scaling_tab(const StrategyScaling& scaling);

}  // namespace delray::apps
