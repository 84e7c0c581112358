// Poses the scene of a process once for each frame, whichever of its ranks comes first, and has the
// ray tracer follow. Ranks meet before, so that nobody still draws the last pose.
#include "apps/render/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "apps/session.h"
#include "apps/statistics.h"
#include "comm/agree_on_failure.h"
#include "comm/collectives.h"
#include "files/error.h"

namespace delray::apps {
namespace {

constexpr double kMostFrames = 1e6;
constexpr std::size_t kPosesThatAreSeen = 24;  // at most, whose boxes the camera shows

// Nothing for any text that is no finite number.
std::optional<double> number_of(std::string_view text) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || at != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

double pose_time_of(const MotionOptions& options) {
  if (options.is_animation()) return parse_animate(options.animate).seconds.front();
  const auto seconds = number_of(options.pose_time);
  if (!seconds) {
    throw UsageError(fmt::format("--pose-time: '{}' is no number of seconds", options.pose_time));
  }
  return *seconds;
}

std::uint32_t animation_of(const MotionOptions& options, const std::string& path,
                           const scenes::Scene& scene) {
  const std::vector<scenes::Animation>& all = scene.animations.animations;
  if (all.empty()) {
    throw UsageError(fmt::format("{}: {} has no animations",
                                 options.is_animation() ? "--animate" : "--pose-time", path));
  }
  if (options.animation.empty()) return 0;
  if (const auto found = scenes::find_animation(scene, options.animation)) return *found;
  std::string names;
  for (std::size_t i = 0; i < all.size(); ++i)
    names += fmt::format("{}{} {}", i == 0 ? "" : ", ", i, all[i].name);
  throw UsageError(
      fmt::format("--animation: {} has no '{}'; it has {}", path, options.animation, names));
}

scenes::Movement pose(const std::string& path, const scenes::Pose& wanted, scenes::Scene& scene) {
  try {
    return scenes::pose(scene, wanted);
  } catch (const std::range_error& error) {
    throw files::FileError(files::Cause::input, path,
                           fmt::format("animation at {:.9g} s", wanted.seconds), error.what());
  }
}

}  // namespace

FrameTimes parse_animate(const std::string& text) {
  const auto refuse = [&](const char* why) -> UsageError {
    return UsageError(fmt::format(
        "--animate: '{}' {}: START:END:FPS, such as 0:2:30, from START up to END seconds", text,
        why));
  };
  const std::size_t first = text.find(':'), second = text.find(':', first + 1);
  if (first == std::string::npos || second == std::string::npos)
    throw refuse("is not three numbers");
  const std::string_view all = text;
  const auto start = number_of(all.substr(0, first)),
             end = number_of(all.substr(first + 1, second - first - 1)),
             rate = number_of(all.substr(second + 1));
  if (!start || !end || !rate) throw refuse("is not three numbers");
  if (!(*rate > 0 && *rate <= 1000)) throw refuse("has frames a second not above 0, up to 1000");
  if (*end < *start) throw refuse("ends before it starts");
  const double count = (*end - *start) * *rate;
  if (!(count <= kMostFrames)) throw refuse("has more than a million frames");
  FrameTimes times;
  times.frames_per_second = std::string(all.substr(second + 1));
  // A frame that would begin at END but for rounding is none.
  for (int i = 0; i == 0 || i < count - 1e-6; ++i) times.seconds.push_back(*start + i / *rate);
  return times;
}

void check(const MotionOptions& options) {
  if (options.is_animation() || !options.pose_time.empty()) pose_time_of(options);
}

void pose_first(const MotionOptions& options, const std::string& path, scenes::Scene& scene) {
  if (!options.is_animation() && options.pose_time.empty()) return;
  pose(path, {animation_of(options, path, scene), pose_time_of(options)}, scene);
}

scenes::FarthestPoints farthest_in_motion(const MotionOptions& options, const std::string& path,
                                          scenes::Scene& scene) {
  const std::uint32_t animation = animation_of(options, path, scene);
  const std::vector<double> seconds = parse_animate(options.animate).seconds;
  const std::size_t poses = std::min(kPosesThatAreSeen, seconds.size());
  geometry::Box3 box;
  // The last is the first again.
  for (std::size_t i = poses; i-- > 0;) {
    pose(path, {animation, seconds[i * seconds.size() / poses]}, scene);
    box.include(scenes::bounds(scene));
  }
  return [box](std::span<const glm::dvec3> directions) {
    return scenes::farthest_corners(box, directions);
  };
}

MovingScene::MovingScene(const MotionOptions& options, std::string path, scenes::Scene& scene,
                         shading::Shader* shader, raytrace::Tracer* tracer)
    : options_(options),
      path_(std::move(path)),
      scene_(scene),
      shader_(shader),
      tracer_(tracer),
      animation_(animation_of(options, path_, scene)),
      seconds_(parse_animate(options.animate).seconds) {
  posed_.motion.seconds = seconds_.front();
}

MovingScene::Posed MovingScene::advance(comm::Communicator& communicator, std::size_t frame) {
  comm::barrier(communicator);
  Posed result;
  comm::all_or_none(communicator, comm::Phase::load, [&] {
    const std::lock_guard lock(mutex_);
    if (frame != frame_) {
      Posed posed;
      Stopwatch watch;
      posed.movement = pose(path_, {animation_, seconds_[frame]}, scene_);
      posed.motion.seconds = seconds_[frame];
      posed.motion.pose_seconds = watch.lap();
      posed.motion.instances = static_cast<std::uint32_t>(posed.movement.instances.size());
      posed.motion.meshes = static_cast<std::uint32_t>(posed.movement.meshes.size());
      if (shader_ != nullptr && posed.movement.lights) shader_->lights = scene_.lights;
      if (tracer_ != nullptr)
        posed.motion.follow = raytrace::follow(*tracer_, scene_, posed.movement);
      posed_ = std::move(posed);
      frame_ = frame;
    }
    result = posed_;
  });
  return result;
}

}  // namespace delray::apps
