// One call for each frame of either engine, with the program's options as the engine's own.
#include "apps/render/render_frames.h"

#include <algorithm>

#include "apps/render/bands.h"
#include "apps/render/ray_frame.h"
#include "apps/statistics.h"
#include "comm/collectives.h"
#include "packs/extent.h"
#include "parallel/arena.h"
#include "scenes/generate.h"

namespace delray::apps {
namespace {

// Who shows what, where ranks show displays.
std::vector<loadbalance::Region> displays(const RenderRequest& request, int ranks) {
  if (!request.layout.has_displays()) return {};
  return loadbalance::displays_of(*request.layout.wall, ranks);
}

raster::RenderOptions raster_options(const RenderRequest& request, const geometry::Rect& window,
                                     int ranks) {
  const Sharing& sharing = request.sharing;
  raster::RenderOptions options = request.raster;
  options.width = request.width;
  options.height = request.height;
  if (window != geometry::Rect{0, 0, request.width, request.height}) options.window = window;
  options.displays = displays(request, ranks);
  options.owners_draw = request.layout.draw_at_home;
  options.lighting = request.shading == SurfaceLighting::gouraud ? raster::Lighting::gouraud
                                                                 : raster::Lighting::phong;
  options.eye_dome = request.shading == SurfaceLighting::eye_dome;
  options.float_pixels = wants_floats(request);
  options.partition = sharing.partition;
  options.costs = sharing.measured_costs ? raster::CostSource::measured : raster::CostSource::model;
  options.regions_per_rank = sharing.regions_per_rank;
  options.keep_factor = sharing.keep_factor;
  options.schedule = sharing.schedule;
  options.master_works = sharing.master_works;
  options.block = sharing.block;
  options.report_partition = !request.statistics.empty();
  return options;
}

raytrace::RenderOptions raytrace_options(const RenderRequest& request, int ranks,
                                         parallel::Progress* progress) {
  const Sharing& sharing = request.sharing;
  raytrace::RenderOptions options = request.raytrace;
  options.width = request.width;
  options.height = request.height;
  options.displays = displays(request, ranks);
  if (request.reach > 0) options.trace.reach = static_cast<float>(request.reach);
  options.trace.background = raytrace::TraceOptions::Background::transparent;
  options.partition = sharing.partition;
  options.costs =
      sharing.measured_costs ? raytrace::CostSource::seconds : raytrace::CostSource::rays;
  options.regions_per_rank = sharing.regions_per_rank;
  options.keep_factor = sharing.keep_factor;
  options.schedule = sharing.schedule;
  options.master_works = sharing.master_works;
  options.tile = sharing.block;
  options.progress = progress;
  return options;
}

raytrace::ShareOptions share_options(const RenderRequest& request) {
  constexpr double kMebibyte = 1 << 20;
  raytrace::ShareOptions options =
      raytrace::share_options(*raytrace::find_distribution(request.data), request.share);
  options.build = request.raytrace.build;
  options.cache_bytes = static_cast<std::uint64_t>(request.cache_mebibytes * kMebibyte);
  return options;
}

// Memory for pages: what the limit leaves, besides pictures, lists of what is in view and tiles,
// for each rank in this process.
raster::PackMemory pack_memory(const RenderRequest& request, const Prepared& prepared) {
  constexpr std::uint64_t kBytesPerPage = 400, kBytesPerPixel = 64, kBase = std::uint64_t{32} << 20;
  constexpr std::uint64_t kLeast = std::uint64_t{8} << 20;
  const files::MemoryBudget budget = request.scene.file.limits.budget();
  const auto pixels =
      static_cast<std::uint64_t>(request.width) * static_cast<std::uint64_t>(request.height) *
      static_cast<std::uint64_t>(request.raster.supersampling * request.raster.supersampling);
  const auto ranks = static_cast<std::uint64_t>(std::max(1, request.launch.ranks));
  const std::uint64_t other = kBase + prepared.pack->pages().size() * kBytesPerPage +
                              pixels * kBytesPerPixel * ranks + writer_bytes(request.output);
  const std::uint64_t left = budget.left();
  raster::PackMemory memory;
  // Blocks of the heap are never as full as they could be.
  memory.cache_bytes = std::max(left > other ? (left - other) / 4 * 3 / ranks : 0, kLeast);
  return memory;
}

}  // namespace

FrameRenderer::FrameRenderer(comm::Communicator& communicator, const Prepared& prepared,
                             const RenderRequest& request, parallel::Progress* progress, int frames)
    : prepared_(prepared), request_(request), progress_(progress) {
  if (prepared.pack && request.engine == Engine::raytrace) {
    const geometry::Box3 box = scenes::bounds(packs::farthest_points(*prepared.pack));
    raytrace::ShareOptions options = share_options(request);
    if (options.cache_bytes == 0) options.cache_bytes = pack_memory(request, prepared).cache_bytes;
    shared_.emplace(raytrace::SharedScene::of_pack(*prepared.pack, prepared.scene, box, options));
    raytrace_.emplace(*shared_, *raytrace::find_distribution(request.data));
    return;
  }
  if (prepared.pack) {
    raster::PackMemory memory = pack_memory(request, prepared);
    memory.one_frame = frames == 1;
    raster_.emplace(*prepared.pack, prepared.scene, memory, prepared.shader);
    return;
  }
  if (request.engine == Engine::raster) {
    if (prepared.part)
      raster_.emplace(communicator, *prepared.part, prepared.shader);
    else
      raster_.emplace(prepared.scene, prepared.shader);
    return;
  }
  if (prepared.tracer) {
    raytrace_.emplace(*prepared.tracer);
    return;
  }
  share(communicator);
}

// Shares the scene out, as it is now.
void FrameRenderer::share(comm::Communicator& communicator) {
  Stopwatch watch;
  raytrace_.reset();
  const raytrace::ShareOptions options = share_options(request_);
  if (prepared_.in_parts || prepared_.part) {
    scenes::ScenePart part = prepared_.part
                                 ? std::move(*prepared_.part)
                                 : scenes::generate_part(request_.scene.file.path,
                                                         communicator.rank(), communicator.size());
    part.scene.lights = prepared_.scene.lights;
    part.scene.environment = prepared_.scene.environment;
    part.scene.textures = prepared_.scene.textures;
    load_seconds_ = watch.lap();
    shared_.emplace(raytrace::SharedScene::make(communicator, std::move(part), options));
  } else {
    shared_.emplace(raytrace::SharedScene::make(communicator, prepared_.scene, options));
  }
  build_seconds_ += watch.lap();
  raytrace_.emplace(*shared_, *raytrace::find_distribution(request_.data));
}

FrameRenderer::Posed FrameRenderer::pose(comm::Communicator& communicator, std::size_t frame) {
  Posed posed{prepared_.cameras[frame], {}};
  if (!prepared_.motion) return posed;
  const MovingScene::Posed now = prepared_.motion->advance(communicator, frame);
  posed.motion = now.motion;
  if (frame > 0 && raster_) raster_->follow(now.movement);
  if (frame > 0 && shared_ && !now.movement.empty()) {
    Stopwatch watch;
    share(communicator);
    posed.motion.follow.build_seconds = watch.lap();
  }
  if (prepared_.camera_number != scenes::kNone) {
    const scenes::Camera& own = prepared_.scene.cameras[prepared_.camera_number];
    posed.camera.eye = own.eye;
    posed.camera.at = own.at;
    posed.camera.up = own.up;
  }
  return posed;
}

Frame FrameRenderer::render(comm::Communicator& communicator, const scenes::Camera& camera,
                            const geometry::Rect& window) {
  Frame frame;
  const int ranks = communicator.size();
  if (raster_) {
    raster::RenderOptions options = raster_options(request_, window, ranks);
    options.error = error_.value_or(options.error);
    raster::Result result = raster_->render(communicator, camera, options, progress_);
    frame.picture = std::move(result.picture);
    frame.shown = std::move(result.shown);
    frame.statistics = std::move(result.statistics);
  } else {
    RenderRequest request = request_;
    request.window = window;
    RayFrame done = trace(communicator, camera, request);
    frame.picture = std::move(done.picture);
    for (image::ImageF& shown : done.shown) frame.shown.emplace_back(std::move(shown));
    frame.statistics = std::move(done.statistics);
    frame.extras = std::move(done.extras);
  }
  return frame;
}

// With --reuse only pixels that the last frames do not tell.
RayFrame FrameRenderer::trace(comm::Communicator& communicator, const scenes::Camera& camera,
                              const RenderRequest& request) {
  raytrace::RenderOptions options = raytrace_options(request, communicator.size(), progress_);
  comm::Buffer traced;
  scenes::View view;
  const bool keeps = communicator.rank() == 0 && request.sampling.reuse > 0;
  if (keeps) {
    view = scenes::make_view(camera, request.width, request.height);
    if (!cache_) cache_.emplace(request.width, request.height, request.sampling.reuse);
    traced = comm::Buffer::of(std::span<const std::uint8_t>(cache_->plan(view)));
  }
  if (request.sampling.reuse > 0) {
    traced = comm::broadcast(communicator, 0, std::move(traced));
    options.part.pixels = traced.as<std::uint8_t>();
  }
  RayFrame done = render_rays(communicator, *raytrace_, prepared_, request, camera, options,
                              {preview_, growth_});
  if (keeps) cache_->complete(view, done.picture);
  return done;
}

bool FrameRenderer::has_steps(int ranks) const {
  // Frames in steps would be several that read pages, or look at poses, at the same time.
  return raster_ && !prepared_.pack && !prepared_.motion &&
         raster::Renderer::has_steps(raster_options(request_, request_.window, ranks), ranks);
}

std::unique_ptr<raster::FrameInSteps> FrameRenderer::begin(comm::Communicator& communicator,
                                                           const scenes::Camera& camera) {
  return raster_->begin(communicator, camera,
                        raster_options(request_, request_.window, communicator.size()), progress_);
}

Frames render_frames(comm::Communicator& communicator, const Prepared& prepared,
                     const RenderRequest& request, parallel::Progress* progress,
                     const std::function<void(Picture&&)>& preview) {
  FrameRenderer renderer(communicator, prepared, request, progress, request.frames);
  renderer.set_preview(preview);
  Frames frames;
  if (request.frames > 1) frames.picture = renderer.render(communicator, prepared.camera).picture;
  for (int i = 0; i < request.frames; ++i) {
    renderer.recycle(std::move(frames.picture));
    barrier(communicator);
    Stopwatch watch;
    Frame frame = renderer.render(communicator, prepared.camera);
    frames.seconds.push_back(watch.lap());
    frames.picture = std::move(frame.picture);
    frames.shown = std::move(frame.shown);
    frames.statistics = std::move(frame.statistics);
    frames.extras = std::move(frame.extras);
  }
  frames.launched = launched(communicator, renderer);
  return frames;
}

Launched launched(comm::Communicator& communicator, const FrameRenderer& renderer) {
  Launched result;
  result.threads = parallel::arena_threads();
  result.load_seconds = renderer.load_seconds();
  result.build_seconds = renderer.build_seconds();
  for (const comm::Buffer& peak :
       comm::gather(communicator, 0, comm::Buffer::of_value(peak_memory()))) {
    result.peak_rss.push_back(peak.as<std::uint64_t>()[0]);
  }
  return result;
}

}  // namespace delray::apps
