// Sends the frames of an animation through a pipeline of stages, and the first two frames alone
// through it, to measure the stages undisturbed (Kohout 2004, 2.1, 2.2 and 3.1.1).
//
// A frame in the making owns a slot. Stages that exchange messages take the frames in the same
// order on all ranks; encoding does not, and may overlap with itself. Degenerate: with one or two
// frames nothing overlaps, and speed-ups are 1.
#include "apps/render/animation.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "apps/render/frame_budget.h"
#include "apps/render/write_picture.h"
#include "apps/statistics.h"
#include "comm/agreed_pipeline.h"
#include "comm/collectives.h"
#include "parallel/arena.h"
#include "scenes/camera_path.h"

namespace delray::apps {
namespace {

// Frames in the making at the same time: one for every stage, and a file more for every thread that
// the others do not need, as far as memory for pictures is not worth more.
std::size_t default_slots() {
  return static_cast<std::size_t>(std::clamp(parallel::arena_threads() + 2, 4, 8));
}

// What rank 0 has chosen.
double agreed(comm::Communicator& communicator, double value) {
  return comm::broadcast(communicator, 0, comm::Buffer::of_value(value)).as<double>()[0];
}

// The state of one frame on its way.
struct Slot {
  std::unique_ptr<raster::FrameInSteps> steps;
  Picture picture;
  double seconds = 0;  // in the stages so far
};

std::uint64_t triangles_sent(const raster::Statistics& s) { return s.triangles_travelled; }
std::uint64_t triangles_sent(const raytrace::Statistics&) { return 0; }

raytrace::RayCounts rays_of(const EngineStatistics& statistics) {
  const auto* const traced = std::get_if<raytrace::Statistics>(&statistics);
  return traced == nullptr ? raytrace::RayCounts{} : traced->rays;
}

// Of the pages that a frame drew.
std::uint64_t triangles_of_pages(const raster::Statistics* statistics) {
  std::uint64_t sum = 0;
  if (statistics == nullptr || !statistics->pack) return sum;
  for (const std::uint64_t triangles : statistics->pack->levels) sum += triangles;
  return sum;
}

void add_traffic(const EngineStatistics& statistics, FrameMotion& motion) {
  std::visit(
      [&](const auto& s) {
        for (const auto& rank : s.ranks) motion.bytes += rank.bytes_sent;
        motion.triangles = triangles_sent(s);
      },
      statistics);
}

}  // namespace

std::string frame_path(const std::string& output, std::size_t frame) {
  const std::filesystem::path path(output);
  const std::string name =
      fmt::format("{}-{:04}{}", path.stem().string(), frame, path.extension().string());
  return (path.parent_path() / name).string();
}

std::optional<std::size_t> frame_number(const std::string& path) {
  const std::string stem = std::filesystem::path(path).stem().string();
  const std::size_t digits = stem.size() - (stem.find_last_not_of("0123456789") + 1);
  if (digits == 0 || digits > 9) return {};
  return std::stoul(stem.substr(stem.size() - digits));
}

std::vector<scenes::Camera> animation_cameras(const RenderRequest& request,
                                              const scenes::Scene& scene,
                                              const scenes::Camera& camera,
                                              const glm::dvec3& pivot) {
  if (request.turntable > 0) return scenes::turntable(camera, request.turntable, pivot);
  if (!request.camera_path.empty()) {
    return scenes::interpolate(scenes::read_camera_path(request.camera_path, scene.origin,
                                                        request.scene.file.limits.budget()));
  }
  if (request.motion.is_animation()) {
    const std::size_t frames = parse_animate(request.motion.animate).seconds.size();
    return std::vector<scenes::Camera>(frames, camera);
  }
  return {};
}

Animation render_animation(comm::Communicator& communicator, const Prepared& prepared,
                           const RenderRequest& request, const Session& session,
                           parallel::Progress* progress) {
  const std::vector<scenes::Camera>& cameras = prepared.cameras;
  const bool first_rank = communicator.rank() == 0;
  FrameRenderer renderer(communicator, prepared, request, progress);
  Animation animation;
  animation.slots = request.frames_at_once > 0 ? static_cast<std::size_t>(request.frames_at_once)
                                               : default_slots();
  animation.frames.seconds.resize(cameras.size());
  std::vector<Slot> slots(animation.slots);
  std::vector<parallel::PipelineStage> stages;
  std::size_t done = 0;  // frames that are not the pipeline's at hand
  std::optional<FrameBudget> budget;
  if (request.frame_milliseconds > 0) budget.emplace(request.frame_milliseconds * 1e-3);
  const auto add = [&](std::string name, bool in_order, auto run) {
    stages.push_back({std::move(name), in_order, [&, run](std::size_t item, std::size_t slot) {
                        Stopwatch watch;
                        run(done + item, slots[slot]);
                        slots[slot].seconds += watch.lap();
                      }});
  };
  const auto finish = [&](const scenes::Camera& camera, Slot& slot, Picture&& picture,
                          EngineStatistics&& statistics) {
    slot.picture = std::move(picture);
    if (first_rank) {
      if (shows_nothing(request, slot.picture)) ++animation.empty_frames;
      put_background_behind(request, prepared, camera, request.window, slot.picture);
    }
    animation.frames.statistics = std::move(statistics);
  };
  if (renderer.has_steps(communicator.size())) {
    add("transform", true, [&](std::size_t i, Slot& slot) {
      slot.seconds = 0;
      slot.steps = renderer.begin(communicator, cameras[i]);
      slot.steps->transform();
    });
    add("rasterize", true, [](std::size_t, Slot& slot) { slot.steps->rasterize(); });
    add("compose", true, [&](std::size_t i, Slot& slot) {
      raster::Result result = slot.steps->compose();
      slot.steps.reset();
      finish(cameras[i], slot, std::move(result.picture), std::move(result.statistics));
    });
  } else {
    add("render", true, [&](std::size_t i, Slot& slot) {
      slot.seconds = 0;
      FrameRenderer::Posed posed = renderer.pose(communicator, i);
      double error = request.raster.error;
      if (budget) {
        error = agreed(communicator, budget->error());
        renderer.set_error(error);
      }
      Stopwatch watch;
      Frame frame = renderer.render(communicator, posed.camera);
      posed.motion.frame_seconds = watch.lap();
      const auto* const drawn = std::get_if<raster::Statistics>(&frame.statistics);
      if (budget) budget->took(posed.motion.frame_seconds, triangles_of_pages(drawn));
      if (prepared.pack && drawn != nullptr && first_rank) {
        animation.errors.push_back(error);
        animation.triangles.push_back(drawn->triangles_rasterized);
      }
      add_traffic(frame.statistics, posed.motion);
      animation.rays += rays_of(frame.statistics);
      if (prepared.motion) animation.motion.push_back(posed.motion);
      finish(posed.camera, slot, std::move(frame.picture), std::move(frame.statistics));
    });
  }
  const std::size_t collective = stages.size() - 1;
  add("encode", false, [&](std::size_t i, Slot& slot) {
    animation.frames.seconds[i] = slot.seconds;
    if (!first_rank) return;
    std::string hash = write_picture(session, frame_path(request.frames_output, i), slot.picture);
    if (i + 1 == cameras.size()) animation.hash = std::move(hash);
  });
  for (const parallel::PipelineStage& stage : stages) animation.stages.push_back(stage.name);
  animation.all.stages.resize(stages.size());
  const auto pass = [&](std::size_t frames) {
    parallel::PipelineTimes times =
        comm::run_agreed_pipeline(communicator, frames, animation.slots, stages, collective);
    done += frames;
    for (std::size_t i = 0; i < stages.size(); ++i) animation.all.stages[i] += times.stages[i];
    animation.all.seconds += times.seconds;
    return times;
  };
  while (done < std::min<std::size_t>(2, cameras.size())) animation.alone = pass(1);
  animation.overlapped = cameras.size() - done;
  animation.overlapped_seconds = pass(animation.overlapped).seconds;
  animation.frames.launched = launched(communicator, renderer);
  return animation;
}

double Animation::sequential_seconds() const {
  return parallel::sequential_seconds(alone) * static_cast<double>(overlapped);
}

double Animation::predicted_seconds() const {
  parallel::PipelineTimes times = alone;
  for (double& stage : times.stages) stage *= static_cast<double>(overlapped);
  return parallel::predicted_seconds(times, overlapped);
}

double Animation::speed_up() const {
  return overlapped == 0 ? 1 : sequential_seconds() / overlapped_seconds;
}

double Animation::predicted_speed_up() const {
  return overlapped == 0 ? 1 : sequential_seconds() / predicted_seconds();
}

}  // namespace delray::apps
