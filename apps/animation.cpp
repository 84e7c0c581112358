#include "apps/animation.h"

#include <fmt/format.h>

#include <filesystem>

#include "apps/statistics.h"
#include "apps/write_picture.h"
#include "comm/agree_on_failure.h"
#include "scenes/camera_path.h"

namespace delray::apps {
namespace {

// Frames that are worked on at the same time: one in every stage, and one that waits.
constexpr std::size_t kSlots = 4;

// What becomes of one frame on its way.
struct Slot {
  Frame frame;
  std::string hash;
};

Animation render_in_pipeline(comm::Communicator& communicator, const Prepared& prepared,
                             const RenderRequest& request, const Session& session,
                             parallel::Progress* progress) {
  const std::vector<scenes::Camera>& cameras = prepared.cameras;
  FrameRenderer renderer(prepared, request, progress);
  std::vector<Slot> slots(kSlots);
  Animation animation;
  const std::vector<std::string> names = animation_stages();
  const std::vector<parallel::PipelineStage> stages = {
      {names[0], true,
       [&](std::size_t i, std::size_t slot) {
         Stopwatch watch;
         slots[slot].frame = renderer.render(communicator, cameras[i]);
         animation.frames.seconds.push_back(watch.lap());
       }},
      {names[1], false,
       [&](std::size_t i, std::size_t slot) {
         slots[slot].hash = write_picture(request, session, prepared, cameras[i],
                                          frame_path(request.output, i), slots[slot].frame.picture);
       }},
      {names[2], true, [&](std::size_t, std::size_t slot) {
         animation.frames.statistics = std::move(slots[slot].frame.statistics);
         animation.hash = std::move(slots[slot].hash);
       }}};
  animation.times = parallel::run_pipeline(cameras.size(), kSlots, stages);
  return animation;
}

Animation render_one_by_one(comm::Communicator& communicator, const Prepared& prepared,
                            const RenderRequest& request, const Session& session,
                            parallel::Progress* progress) {
  const std::vector<scenes::Camera>& cameras = prepared.cameras;
  FrameRenderer renderer(prepared, request, progress);
  Animation animation;
  animation.times.stages.resize(animation_stages().size());
  Stopwatch all;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    Stopwatch watch;
    Frame frame = renderer.render(communicator, cameras[i]);
    animation.frames.seconds.push_back(watch.lap());
    animation.times.stages[0] += animation.frames.seconds.back();
    comm::all_or_none(communicator, comm::Phase::other, [&] {
      if (communicator.rank() == 0) {
        animation.hash = write_picture(request, session, prepared, cameras[i],
                                       frame_path(request.output, i), frame.picture);
      }
    });
    animation.times.stages[1] += watch.lap();
    animation.frames.statistics = std::move(frame.statistics);
  }
  animation.times.seconds = all.lap();
  return animation;
}

}  // namespace

std::string frame_path(const std::string& output, std::size_t frame) {
  const std::filesystem::path path(output);
  const std::string name =
      fmt::format("{}-{:04}{}", path.stem().string(), frame, path.extension().string());
  return (path.parent_path() / name).string();
}

std::vector<scenes::Camera> animation_cameras(const RenderRequest& request,
                                              const scenes::Scene& scene,
                                              const scenes::Camera& camera) {
  if (request.turntable > 0) return scenes::turntable(camera, request.turntable);
  if (!request.camera_path.empty()) {
    return scenes::interpolate(scenes::read_camera_path(request.camera_path, scene.origin));
  }
  return {};
}

std::vector<std::string> animation_stages() { return {"render", "write", "report"}; }

Animation render_animation(comm::Communicator& communicator, const Prepared& prepared,
                           const RenderRequest& request, const Session& session,
                           parallel::Progress* progress) {
  return communicator.size() == 1
             ? render_in_pipeline(communicator, prepared, request, session, progress)
             : render_one_by_one(communicator, prepared, request, session, progress);
}

}  // namespace delray::apps
