// The statistics of a rendering as JSON (schema delray.render/1).
#pragma once

#include <string>

#include "apps/render/animation.h"
#include "apps/render/render_frames.h"
#include "apps/statistics.h"

namespace delray::apps {

// "camera": of the first frame, in the numbers of --camera.
Json render_statistics(const RenderRequest& request, const Prepared& prepared, const Frames& frames,
                       const std::string& hash, double write_seconds);

// The overlap of an animation's stages: per stage the seconds of all frames, and of one that
// was alone; the speed-up measured over frames that are alone (Kohout 2004, 2.1), and the one
// predicted for a processor for each stage (2.2).
Json animation_statistics(const Animation& animation);

}  // namespace delray::apps
