// What a rendering did, as JSON (schema delray.render/1).
#pragma once

#include <string>

#include "apps/render_frames.h"
#include "apps/statistics.h"

namespace delray::apps {

Json render_statistics(const RenderRequest& request, const Prepared& prepared, const Frames& frames,
                       const std::string& hash, double write_seconds);

}  // namespace delray::apps
