// Scenes that move while frames are rendered.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "comm/communicator.h"
#include "raytrace/tracer.h"
#include "scenes/extent.h"
#include "scenes/pose.h"
#include "shading/shader.h"

namespace delray::apps {

// --pose-time, --animate and --animation.
struct MotionOptions {
  std::string pose_time, animate;  // seconds; START:END:FPS; empty: not given
  std::string animation;           // a name or number; empty: the first

  bool is_animation() const { return !animate.empty(); }
};

// The time of a frame, and what it took to have the renderer follow the scene.
struct FrameMotion {
  double seconds = 0;  // of the animation
  double pose_seconds = 0;
  std::uint32_t instances = 0, meshes = 0;  // that moved and bent since the last frame
  raytrace::FollowCounts follow;            // ray tracer with the whole scene
  double frame_seconds = 0;                 // of the picture
  std::uint64_t bytes = 0, triangles = 0;   // that ranks sent, and of these triangles
};

// Frames of an animation: from START up to END, not included, FPS a second, at least one.
struct FrameTimes {
  std::vector<double> seconds;
  std::string frames_per_second;
};
// Throws UsageError.
FrameTimes parse_animate(const std::string& text);

// Throws UsageError for times that are none.
void check(const MotionOptions& options);

// Puts a scene into the first pose that the options ask for, which is its own where they ask for
// none. Throws UsageError where the scene does not move, files::FileError naming `path` where the
// pose has no place.
void pose_first(const MotionOptions& options, const std::string& path, scenes::Scene& scene);

// What is seen of a scene in any of the poses of --animate: corners of the boxes of some of them.
// The scene is in the first of them before and after.
scenes::FarthestPoints farthest_in_motion(const MotionOptions& options, const std::string& path,
                                          scenes::Scene& scene);

// The scene of a process and what renderers made of it, from frame to frame. Ranks of one process
// share it.
class MovingScene {
 public:
  // Refers to all of them; a tracer or shader may be null.
  MovingScene(const MotionOptions& options, std::string path, scenes::Scene& scene,
              shading::Shader* shader, raytrace::Tracer* tracer);

  // Collective: the scene as it is in frame i. Returns what has changed since the last call.
  // Throws what all ranks throw.
  struct Posed {
    scenes::Movement movement;
    FrameMotion motion;
  };
  Posed advance(comm::Communicator& communicator, std::size_t frame);

 private:
  MotionOptions options_;
  std::string path_;
  scenes::Scene& scene_;
  shading::Shader* shader_;
  raytrace::Tracer* tracer_;
  std::uint32_t animation_;
  std::vector<double> seconds_;  // by frame
  std::mutex mutex_;
  std::size_t frame_ = 0;
  Posed posed_;  // of that frame
};

}  // namespace delray::apps
