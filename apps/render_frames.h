// Frames of a scene on one rank: the part of `delray render` that runs on every rank.
#pragma once

#include <memory>
#include <variant>
#include <vector>

#include "apps/render_options.h"
#include "comm/communicator.h"
#include "scenes/scene.h"
#include "shading/shader.h"

namespace delray::apps {

// A scene ready to be rendered; shared by the ranks of a process.
struct Prepared {
  scenes::Scene scene;
  scenes::Camera camera;
  Background background;                           // not automatic any more
  std::shared_ptr<const shading::Shader> shader;   // rasterizer
  std::unique_ptr<const raytrace::Tracer> tracer;  // ray tracer
  double load_seconds = 0, build_seconds = 0;

  const shading::Shader& shading() const { return tracer ? tracer->shader : *shader; }
};

// Loads the scene, chooses the camera, builds what the engine needs. Parallel in the caller's
// arena.
std::shared_ptr<const Prepared> prepare(const RenderRequest& request, parallel::Progress* progress);

// On rank 0; elsewhere the pictures are of size 0.
struct Frames {
  std::variant<image::Image8, image::ImageF> picture;  // of the last frame
  std::variant<raster::Statistics, raytrace::Statistics> statistics;
  std::vector<double> seconds;  // per frame, from the scene in memory to the picture on rank 0
};

// Collective. With more than one frame a further one goes before, to warm up.
Frames render_frames(comm::Communicator& communicator, const Prepared& prepared,
                     const RenderRequest& request, parallel::Progress* progress);

}  // namespace delray::apps
