// Frames of a scene on one rank: the part of `delray render` that runs on every rank.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "apps/render/motion.h"
#include "apps/render/options/render_options.h"
#include "apps/render/prepare.h"
#include "comm/communicator.h"
#include "image/io.h"
#include "packs/pack_reader.h"
#include "raytrace/film.h"
#include "raytrace/render_cache.h"
#include "scenes/scene.h"
#include "shading/shader.h"

namespace delray::apps {

// Channels of a ray traced picture, and facts of its sampling; on rank 0.
struct Extras {
  std::vector<image::Channel> channels;
  int passes = 0;
  double samples = 0;  // per pixel, on average
  bool out_of_time = false;
  double noisy = 0;  // part of the picture that is noisier than it was to be
};

using Picture = std::variant<image::Image8, image::ImageF>;
using EngineStatistics = std::variant<raster::Statistics, raytrace::Statistics>;

// On rank 0; elsewhere the pictures are of size 0, but for those of displays.
struct Frame {
  Picture picture;
  std::vector<Picture> shown;  // on any rank, of the displays that it shows
  EngineStatistics statistics;
  Extras extras;
};

struct RayFrame;

// A ray traced picture that grows while somebody looks at it: pass by pass, until it is done or
// something else is wanted. It goes on from where it was left. Of rank 0, but for goes_on and show
// not being empty.
struct Growth {
  std::function<bool()> goes_on;  // asked some 30 times a second; false: ends
  std::function<void(Picture&& picture, double samples)> show;  // samples per pixel, on average
  bool is_done = false;
  raytrace::Film film;                   // of a picture that was left
  std::vector<std::uint8_t> cells_left;  // of its last pass
};

// Either engine, ready for any number of frames. One per rank; refers to what it is given.
class FrameRenderer {
 public:
  // Collective: with some --data this rank makes its part of the scene. `frames`: how many will be
  // rendered; 0: nobody knows.
  FrameRenderer(comm::Communicator& communicator, const Prepared& prepared,
                const RenderRequest& request, parallel::Progress* progress, int frames = 0);
  // The time of that part.
  double load_seconds() const { return load_seconds_; }
  double build_seconds() const { return build_seconds_; }
  // Is given pictures that are not yet done, as often as the options want it.
  void set_preview(std::function<void(Picture&&)> preview) { preview_ = std::move(preview); }
  // Ray traced frames grow, from the next one on; null: they do not. A frame that is left before it
  // is done has a picture of size 0.
  void set_growth(Growth* growth) { growth_ = growth; }
  // Collective: the scene as it is in a frame of an animation, and where it is seen from.
  struct Posed {
    scenes::Camera camera;
    FrameMotion motion;
  };
  Posed pose(comm::Communicator& communicator, std::size_t frame);
  // Collective. The window of the request, or another part of the frame.
  Frame render(comm::Communicator& communicator, const scenes::Camera& camera) {
    return render(communicator, camera, request_.window);
  }
  Frame render(comm::Communicator& communicator, const scenes::Camera& camera,
               const geometry::Rect& window);
  // Another bound of error, of packs (raster::RenderOptions::error), from the next frame on.
  void set_error(double error) { error_ = error; }
  // Gives the memory of a picture, as render returned it, to the next frame where that takes less
  // time so.
  void recycle(Picture&& picture) {
    if (raster_) raster_->recycle(std::move(picture));
  }
  // Renders a frame in steps (raster::Renderer::begin), where engine and strategy have them.
  bool has_steps(int ranks) const;
  std::unique_ptr<raster::FrameInSteps> begin(comm::Communicator& communicator,
                                              const scenes::Camera& camera);

 private:
  void share(comm::Communicator& communicator);
  RayFrame trace(comm::Communicator& communicator, const scenes::Camera& camera,
                 const RenderRequest& request);

  const Prepared& prepared_;
  const RenderRequest& request_;
  parallel::Progress* progress_;
  std::function<void(Picture&&)> preview_;
  Growth* growth_ = nullptr;
  std::optional<raster::Renderer> raster_;       // one of the two
  std::optional<raytrace::SharedScene> shared_;  // of the next, with some --data
  std::optional<raytrace::Renderer> raytrace_;
  std::optional<double> error_;
  std::optional<raytrace::RenderCache> cache_;  // on rank 0, of an animation that asks for one
  double load_seconds_ = 0, build_seconds_ = 0;
};

// Facts of how ranks were launched; on rank 0.
struct Launched {
  int threads = 0;                      // of each rank
  double load_seconds = 0;              // beside what `Prepared` tells, of this rank
  double build_seconds = 0;             // likewise
  std::vector<std::uint64_t> peak_rss;  // by rank: bytes, of its process
};

// The last of some frames from the same camera.
struct Frames {
  Picture picture;
  std::vector<Picture> shown;  // on any rank
  EngineStatistics statistics;
  Extras extras;
  std::vector<double> seconds;  // per frame, from the scene in memory to the picture on rank 0
  Launched launched;
};

// Collective.
Launched launched(comm::Communicator& communicator, const FrameRenderer& renderer);

// Collective. With more than one frame a further one goes before, to warm up.
Frames render_frames(comm::Communicator& communicator, const Prepared& prepared,
                     const RenderRequest& request, parallel::Progress* progress,
                     const std::function<void(Picture&&)>& preview = {});

}  // namespace delray::apps
