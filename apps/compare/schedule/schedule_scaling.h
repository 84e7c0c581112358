// How schedules scale, as a tab of the page.
#pragma once

#include "apps/compare/schedule/compare_schedule.h"
#include "apps/report/html.h"

namespace delray::apps {

// "Whole frames": times, efficiency, where schedules stop gaining, and where the busiest rank's
// time goes. REQUIRES: there are rows.
report::Html schedule_scaling_tab(const ScheduleComparison& comparison);

}  // namespace delray::apps
