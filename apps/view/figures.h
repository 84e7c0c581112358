// What the last frame cost its ranks, for a page to show.
#pragma once

#include "apps/render/render_frames.h"
#include "apps/statistics.h"

namespace delray::apps::view {

// {"width", "height": of the frame; "regions": [{"x", "y", "width", "height", "rank"}] of those who
// own parts of it; "loads": by rank, busy time over its mean; "busy": seconds by rank; "imbalance":
// max over mean; "bytes", "messages": of all ranks; "html": table and time line}. Counts are exact,
// times measured.
Json figures_of(const EngineStatistics& statistics, int width, int height);

}  // namespace delray::apps::view
