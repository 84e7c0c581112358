// The comparison of schedules as a page.
#pragma once

#include <string>

#include "apps/compare/schedule/compare_schedule.h"

namespace delray::apps {

std::string schedule_report(const Session& session, const ScheduleRequest& request,
                            const Prepared& prepared, const ScheduleComparison& comparison);

}  // namespace delray::apps
