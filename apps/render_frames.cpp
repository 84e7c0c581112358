#include "apps/render_frames.h"

#include "apps/statistics.h"
#include "comm/collectives.h"

namespace delray::apps {
namespace {

bool wants_floats(const RenderRequest& request) {
  return request.output.ends_with(".exr") || request.output.ends_with(".EXR");
}

// Whether the scene itself says what is to be seen around it.
bool has_sky(const scenes::Environment& environment) {
  return environment.texture != scenes::kNone ||
         environment.zenith + environment.horizon + environment.ground != glm::vec3(0.0F);
}

raster::RenderOptions raster_options(const RenderRequest& request) {
  raster::RenderOptions options;
  options.width = request.width;
  options.height = request.height;
  options.float_pixels = wants_floats(request);
  options.lighting =
      request.lighting == "gouraud" ? raster::Lighting::gouraud : raster::Lighting::phong;
  options.strategy = request.strategy;
  options.scheme = request.scheme;
  options.partition = request.partition;
  return options;
}

raytrace::RenderOptions raytrace_options(const RenderRequest& request,
                                         parallel::Progress* progress) {
  raytrace::RenderOptions options;
  options.width = request.width;
  options.height = request.height;
  options.samples = request.samples;
  options.trace.depth = request.depth;
  options.trace.background = raytrace::TraceOptions::Background::transparent;
  options.integrator = request.integrator;
  options.schedule = request.schedule;
  options.progress = progress;
  return options;
}

// Calls frame() once to warm up, if there is more than one to come, then request.frames times.
template <class Frame>
void repeat(comm::Communicator& communicator, int frames, std::vector<double>& seconds,
            Frame&& frame) {
  if (frames > 1) frame();
  for (int i = 0; i < frames; ++i) {
    barrier(communicator);
    Stopwatch watch;
    frame();
    seconds.push_back(watch.lap());
  }
}

}  // namespace

std::shared_ptr<const Prepared> prepare(const RenderRequest& request,
                                        parallel::Progress* progress) {
  auto prepared = std::make_shared<Prepared>();
  Stopwatch watch;
  prepared->scene = load_scene(request.scene, progress);
  prepared->camera =
      choose_camera(request.camera, prepared->scene,
                    static_cast<float>(request.width) / static_cast<float>(request.height));
  prepared->background = request.behind;
  if (prepared->background.kind == Background::Kind::automatic) {
    prepared->background.kind = has_sky(prepared->scene.environment) ? Background::Kind::environment
                                                                     : Background::Kind::studio;
  }
  complete(prepared->scene, prepared->camera);
  prepared->load_seconds = watch.lap();
  if (request.kind == Engine::raster) {
    prepared->shader =
        std::make_shared<const shading::Shader>(shading::make_shader(prepared->scene));
  } else {
    prepared->tracer =
        std::make_unique<const raytrace::Tracer>(raytrace::make_tracer(prepared->scene));
  }
  prepared->build_seconds = watch.lap();
  return prepared;
}

Frames render_frames(comm::Communicator& communicator, const Prepared& prepared,
                     const RenderRequest& request, parallel::Progress* progress) {
  Frames frames;
  if (request.kind == Engine::raster) {
    raster::Renderer renderer(prepared.scene, prepared.shader);
    const raster::RenderOptions options = raster_options(request);
    raster::Result result;
    repeat(communicator, request.frames, frames.seconds,
           [&] { result = renderer.render(communicator, prepared.camera, options, progress); });
    frames.picture = std::move(result.picture);
    frames.statistics = std::move(result.statistics);
  } else {
    const raytrace::RenderOptions options = raytrace_options(request, progress);
    raytrace::Result result;
    repeat(communicator, request.frames, frames.seconds, [&] {
      result = raytrace::render(communicator, *prepared.tracer, prepared.camera, options);
    });
    frames.picture = std::move(result.image);
    frames.statistics = std::move(result.statistics);
  }
  return frames;
}

}  // namespace delray::apps
