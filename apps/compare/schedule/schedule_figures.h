// The results of a comparison of schedules, as JSON and as text.
#pragma once

#include "apps/compare/schedule/compare_schedule.h"

namespace delray::apps {

// `delray.compare.schedule/1`.
Json schedule_statistics(const ScheduleRequest& request, const Prepared& prepared,
                         const ScheduleComparison& comparison);
// A heading and a line for each row.
TextTable schedule_table(const ScheduleComparison& comparison);

}  // namespace delray::apps
