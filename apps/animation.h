// `delray render` of many frames from changing cameras.
#pragma once

#include <string>
#include <vector>

#include "apps/render_frames.h"
#include "apps/session.h"
#include "parallel/pipeline.h"

namespace delray::apps {

// Where frame `frame` of an animation goes: "a.png" gives "a-0007.png".
std::string frame_path(const std::string& output, std::size_t frame);

// The cameras that --turntable and --camera-path ask for; none for a single picture. Throws
// UsageError, files::FileError.
std::vector<scenes::Camera> animation_cameras(const RenderRequest& request,
                                              const scenes::Scene& scene,
                                              const scenes::Camera& camera);

// What the frames took, on rank 0. With one rank the stages of a pipeline; with several, whose
// messages only their own threads may send, one frame after the other.
struct Animation {
  Frames frames;  // the picture is the last one, already written
  std::string hash;
  parallel::PipelineTimes times;
};
std::vector<std::string> animation_stages();

// Collective. Every frame is written as it is finished; `progress` is that of the frame in the
// making.
Animation render_animation(comm::Communicator& communicator, const Prepared& prepared,
                           const RenderRequest& request, const Session& session,
                           parallel::Progress* progress);

}  // namespace delray::apps
