// The options of `delray render`.
#pragma once

#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "apps/input/scene_input.h"
#include "apps/launch.h"
#include "apps/render/background.h"
#include "apps/render/frame_layout.h"
#include "apps/render/motion.h"
#include "apps/render/options/camera_options.h"
#include "apps/render/options/light_options.h"
#include "apps/render/options/sampling_options.h"
#include "apps/statistics.h"
#include "raster/render.h"
#include "raytrace/checkpoint.h"
#include "raytrace/render.h"

namespace delray::apps {

enum class Engine { raster, raytrace };
enum class SurfaceLighting { phong, gouraud, eye_dome };

// Options of sharing the picture out among ranks, for either engine.
struct Sharing {
  std::string partition = "mahd", schedule;
  bool measured_costs = false, master_works = true;
  int regions_per_rank = 1, block = 64;
  double keep_factor = 1.1;
};

struct RenderRequest {
  SceneInput scene;
  CameraOptions camera;
  LightOptions light;
  Launch launch;
  std::string output, statistics;
  std::string size = "1280x720", background = "auto";
  Engine engine = Engine::raster;
  std::string camera_path;
  int frames = 1, turntable = 0, frames_at_once = 0;  // 0: by the threads
  double frame_milliseconds = 0;  // of an animation of a pack; 0: however long it takes
  bool list = false, legend = false;
  SurfaceLighting shading = SurfaceLighting::phong;
  Sharing sharing;
  raster::RenderOptions raster;
  raytrace::RenderOptions raytrace;
  raytrace::ShareOptions share;
  std::string data = "replicated";  // of raytrace::distributions()
  double cache_mebibytes = 0;       // 0: a tenth of the scene
  double reach = 0;                 // of ambient occlusion; 0: without end
  SamplingOptions sampling;
  MotionOptions motion;
  FrameLayout layout;

  // The size of the pictures that are written: the frame, or a crop of it; of a wall all that its
  // displays and bezels show and hide, or, in one file, what the displays show.
  int picture_width() const {
    return layout.one_file ? layout.wall->columns * layout.wall->width : window.width();
  }
  int picture_height() const {
    return layout.one_file ? layout.wall->rows * layout.wall->height : window.height();
  }
  bool is_animation() const {
    return turntable > 0 || !camera_path.empty() || motion.is_animation();
  }

  // Set by check:
  std::string frames_output;  // of which frame_path makes the names of an animation's frames
  int width = 0, height = 0;  // of the frame: of all of a wall, what bezels hide included
  geometry::Rect window;      // of the frame
  Background behind;
};

inline bool is_raytrace(const RenderRequest& request) { return request.engine == Engine::raytrace; }

// Sets width, height and window by size. Throws UsageError.
void parse_size(RenderRequest& request);

void add_render_options(CLI::App& command, RenderRequest& request);
// Some of them, for commands that have no others.
void add_options(std::initializer_list<std::string_view> names, CLI::App& command,
                 RenderRequest& request);
// Throws UsageError where an option was given and changes nothing.
void refuse_if_idle(std::string_view name, const CLI::App& command, const RenderRequest& request);

// An option beside the others of a request.
struct OptionState {
  Json value;            // that it has, given or not
  std::string why_idle;  // why it changes nothing; empty: it does
};
// By long name, of those that are rows. `request` is as the command line has set it.
std::map<std::string, OptionState> option_states(const CLI::App& command, RenderRequest request);

// The options that were chosen, by their names in statistics: those that the engine and the
// strategy look at.
Json chosen_options(const RenderRequest& request);

// The options that the ray tracer's samples depend on, as checkpoints keep them. REQUIRES: a
// request that check() completed.
std::vector<raytrace::NamedValue> checkpoint_options(const RenderRequest& request);

// Completes and checks a request. Throws UsageError for values that are not legal and for options
// that have no effect with the others.
void check(const CLI::App& command, RenderRequest& request);

}  // namespace delray::apps
