// What a rendering did, as JSON (schema delray.render/1).
#pragma once

#include <string>

#include "apps/animation.h"
#include "apps/render_frames.h"
#include "apps/statistics.h"

namespace delray::apps {

Json render_statistics(const RenderRequest& request, const Prepared& prepared, const Frames& frames,
                       const std::string& hash, double write_seconds);

// How the stages of an animation overlapped: the speed-up over one stage after the other, and the
// one that a processor for each stage would give (Kohout 2004, 2.2).
Json animation_statistics(const Animation& animation, std::size_t frames);

}  // namespace delray::apps
