// The options of `delray render`.
#pragma once

#include <string>

#include "apps/input/scene_input.h"
#include "apps/launch.h"
#include "apps/render/background.h"
#include "apps/render/camera_options.h"
#include "apps/render/light_options.h"
#include "apps/render/practice_options.h"
#include "raster/render.h"
#include "raytrace/render.h"

namespace delray::apps {

enum class Engine { raster, raytrace };

struct RenderRequest {
  SceneInput scene;
  CameraOptions camera;
  LightOptions light;
  Launch launch;
  std::string output, statistics;
  std::string size = "1280x720", engine = "raster", background = "auto";
  std::string camera_path;
  int frames = 1, turntable = 0, frames_at_once = 0;  // 0: by the threads
  bool list = false;
  // raster
  std::string strategy = "sort-last", partition = "mahd", scheme = "binary-swap",
              lighting = "phong", codec = "dense", shade = "deferred", blend = "by-owner",
              travel = "geometry", groups = "one", redistribution = "immediate";
  std::string costs = "model";
  int supersampling = 1, regions_per_rank = 1, block = 64, geometry_ranks = 0;
  double keep_factor = 1.2;
  // raytrace; schedule is raster's too
  std::string integrator = "whitted", schedule, master = "works", data = "replicated",
              deal = "neighbours";
  double cache_mebibytes = 0;  // 0: a tenth of the scene
  int samples = 1, depth = 8, diffuse_depth = 64;
  double reach = 0;  // 0: without end
  bool no_shadows = false;
  std::string build = "medium", isa = "best";
  Practice practice;

  bool is_animation() const { return turntable > 0 || !camera_path.empty(); }

  // Set by check:
  std::string frames_output;  // of which frame_path makes the names of an animation's frames
  int width = 0, height = 0;
  Engine kind = Engine::raster;
  Background behind;
};

// Sets width and height by size. Throws UsageError.
void parse_size(RenderRequest& request);

void add_render_options(CLI::App& command, RenderRequest& request);

// Completes and checks a request. Throws UsageError for values that are not legal and for options
// that have no effect with the others.
void check(const CLI::App& command, RenderRequest& request);

}  // namespace delray::apps
