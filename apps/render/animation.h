// `delray render` of many frames from changing cameras.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/render/render_frames.h"
#include "apps/session.h"
#include "parallel/pipeline.h"

namespace delray::apps {

// Where frame `frame` of an animation goes: "a.png" gives "a-0007.png".
std::string frame_path(const std::string& output, std::size_t frame);
// The only frame that may go to `path`, by the number at the end of its stem.
std::optional<std::size_t> frame_number(const std::string& path);

// The cameras that --turntable (about the vertical through `pivot`) and --camera-path ask for; none
// for a single picture. Throws UsageError, files::FileError.
std::vector<scenes::Camera> animation_cameras(const RenderRequest& request,
                                              const scenes::Scene& scene,
                                              const scenes::Camera& camera,
                                              const glm::dvec3& pivot);

// Times of the frames on rank 0, in a pipeline over the stages below. The first two pass alone,
// since stages that share processors take longer than what formulas about them ask for.
struct Animation {
  Frames frames;  // the statistics are the last one's; the picture has gone to its file
  std::string hash;
  // Of each frame, where it is a pack's: the bound of error that it had, and triangles drawn.
  std::vector<double> errors;
  std::vector<std::uint64_t> triangles;
  std::vector<FrameMotion> motion;  // by frame, of a scene that moves
  raytrace::RayCounts rays;         // of all frames
  std::vector<std::string> stages;
  std::size_t empty_frames = 0;   // that show nothing of the scene
  std::size_t slots = 0;          // frames in the making at the same time
  parallel::PipelineTimes all;    // frames
  parallel::PipelineTimes alone;  // the second frame, or the only one
  std::size_t overlapped = 0;     // frames that others were in the making beside
  double overlapped_seconds = 0;

  // Seconds of the overlapped frames if each is alone (Kohout 2004, 2.1), and with a processor for
  // every stage (2.2).
  double sequential_seconds() const;
  double predicted_seconds() const;
  // 1 where none overlapped.
  double speed_up() const;
  double predicted_speed_up() const;
};

// Collective. Every frame is written as it is finished. Stages (Kohout 2004, 3.1.1) are transform,
// rasterize, compose (over ranks, and with the background) and encode, which also writes the file.
// Where a frame has no steps, since ranks exchange messages before they draw or learn from the last
// frame, what comes before encode is one stage, render.
Animation render_animation(comm::Communicator& communicator, const Prepared& prepared,
                           const RenderRequest& request, const Session& session,
                           parallel::Progress* progress);

}  // namespace delray::apps
