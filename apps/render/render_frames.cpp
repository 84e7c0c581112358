// Prepares a scene for either engine and renders frames of it: options into the engine's own,
// checks of memory before it is taken, cameras, lights, then one call for each frame.
//
// Scenes that come in parts are prepared on every rank without geometry; cameras that show all of
// it are agreed upon by the farthest points of all ranks.
#include "apps/render/render_frames.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "apps/render/animation.h"
#include "apps/render/bands.h"
#include "apps/render/ray_frame.h"
#include "apps/render/scene_facts.h"
#include "apps/statistics.h"
#include "comm/agree_on_failure.h"
#include "comm/collectives.h"
#include "packs/extent.h"
#include "parallel/arena.h"
#include "raster/strategies.h"
#include "raytrace/checkpoint.h"
#include "scenes/framing.h"
#include "scenes/generate.h"
#include "scenes/points.h"
#include "shading/take_shader.h"

namespace delray::apps {
namespace {

bool wants_floats(const RenderRequest& request) {
  return image::picture_suffix(request.output) == ".exr";
}

// Whether the scene itself says what is to be seen around it.
bool has_sky(const scenes::Environment& environment) {
  return environment.texture != scenes::kNone ||
         environment.zenith + environment.horizon + environment.ground != glm::vec3(0.0F);
}

void set_lens(const SamplingOptions& sampling, scenes::Camera& camera) {
  camera.aperture = static_cast<float>(sampling.aperture);
  camera.focus = static_cast<float>(sampling.focus);
}

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

// Whether the generator can make parts of the scene, and nothing changes what it makes.
bool has_parts(const RenderRequest& request) {
  if (!request.scene.colour_by.empty() || !request.scene.up.empty()) return false;
  try {
    return scenes::has_parts(request.scene.file.path);
  } catch (const std::invalid_argument&) {
    return false;  // loading says what is wrong
  }
}

bool is_replicated(const RenderRequest& request) {
  return raytrace::find_distribution(request.data)->replicated;
}

// Whether no rank need ever have the whole scene.
bool comes_in_parts(const RenderRequest& request) {
  return request.engine == Engine::raytrace && !is_replicated(request) && has_parts(request);
}

raytrace::ShareOptions share_options(const RenderRequest& request) {
  constexpr double kMebibyte = 1 << 20;
  raytrace::ShareOptions options = request.share;
  options.build = request.raytrace.build;
  options.cache_bytes = static_cast<std::uint64_t>(request.cache_mebibytes * kMebibyte);
  return options;
}

bool has_tracer(const RenderRequest& request) {
  return request.engine == Engine::raytrace && is_replicated(request);
}

// Measured with one rank, peak and file included.
std::uint64_t bytes_per_pixel(const RenderRequest& request) {
  const bool floats = wants_floats(request);
  if (request.engine == Engine::raster) return floats ? 48 : 12;
  if (request.sampling.channels || request.sampling.denoise) return 140;
  return floats ? 48 : 33;
}

bool has_layers(const RenderRequest& request) {
  return request.engine == Engine::raster &&
         raster::find_strategy(request.raster.strategy)->composites;
}

// Pictures on their way; of a wall they are those of displays where these are composited one after
// the other, else a part for each process. One that can be written in bands takes what it finds.
void require_memory_for_pictures(const RenderRequest& request) {
  const int ranks = std::max(1, request.launch.ranks);
  auto pixels = static_cast<std::uint64_t>(request.window.area());
  if (comes_in_bands(request)) {
    pixels = static_cast<std::uint64_t>(request.picture_width()) * kLeastBand;
  } else if (const auto& wall = request.layout.wall) {
    const std::uint64_t shown = pixels / static_cast<std::uint64_t>(wall->displays()) + 1;
    if (has_layers(request)) pixels = 2 * shown;
  }
  request.scene.file.limits.budget().require(
      pixels * picture_bytes_per_pixel(request, ranks), request.output,
      fmt::format("{} x {} pixels", request.picture_width(), request.picture_height()));
}

// Bytes that Embree builds for a triangle that is stored: 65 to 87 bytes were measured.
void require_memory_for_embree(const RenderRequest& request, const scenes::Scene& scene) {
  constexpr std::uint64_t kBytesPerTriangle = 65, kBytesPerTriangleQuick = 80;
  std::uint64_t triangles = 0;
  for (const scenes::Mesh& mesh : scene.meshes) triangles += mesh.triangles.size();
  request.scene.file.limits.budget().require(
      triangles * (request.raytrace.build.quality == raytrace::BuildOptions::Quality::low
                       ? kBytesPerTriangleQuick
                       : kBytesPerTriangle),
      request.scene.file.path, fmt::format("Embree's structures of {} triangles", triangles));
}

// Smaller levels are a third of a texture; with distributed data ranks have copies of the textures.
void require_memory_for_textures(const RenderRequest& request, const scenes::Scene& scene) {
  std::uint64_t texels = 0;
  for (const scenes::Texture& texture : scene.textures) texels += texture.texels.size();
  const bool copied = request.engine == Engine::raytrace && !has_tracer(request);
  const std::uint64_t levels = texels / 3, copies = copied ? texels : 0;
  request.scene.file.limits.budget().require((levels + copies) * sizeof(image::Rgba8),
                                             request.scene.file.path, "textures");
}

// Whether pages of a pack are read while they are drawn, or rays want them; otherwise it is
// unpacked, into memory.
bool reads_pages(const RenderRequest& request) {
  if (request.layout.wall || input_kind_of(request.scene.file) != InputKind::pack) return false;
  if (request.engine == Engine::raytrace) {
    const raytrace::Distribution& data = *raytrace::find_distribution(request.data);
    return data.fetches && !data.chooses && request.sampling.checkpoint.empty();
  }
  return raster::find_strategy(request.raster.strategy)->packs &&
         request.sharing.schedule.empty() && request.raster.blend == raster::Blend::by_owner;
}

// Whether rays have to be sent to surfaces, as they are lights.
bool has_glow(const scenes::Scene& scene) {
  return std::ranges::any_of(scene.materials, [](const scenes::Material& material) {
    return material.emission != glm::vec3(0.0F);
  });
}

std::shared_ptr<Prepared> open_pack(const RenderRequest& request) {
  refuse_for_packs(request.scene);
  if (request.motion.is_animation() || !request.motion.pose_time.empty())
    throw UsageError("--animate and --pose-time: packs do not move");
  refuse_outside(request.scene.file.path, request.scene.file.limits);
  auto prepared = std::make_shared<Prepared>();
  auto pack = std::make_unique<packs::PackReader>(request.scene.file.path,
                                                  request.scene.file.limits.budget());
  prepared->scene = pack->take_scene();
  if (!request.scene.up.empty()) prepared->scene.z_up = request.scene.up == "z";
  prepared->triangles = pack->first_primitives().back();
  for (const scenes::Instance& instance : prepared->scene.instances) {
    const packs::MeshRow& mesh = pack->meshes()[instance.mesh];
    if (mesh.shape.kind != scenes::Shape::Kind::triangle) prepared->points += mesh.triangles;
  }
  prepared->vertices = pack->vertices();
  prepared->pack = std::move(pack);
  return prepared;
}

scenes::FarthestPoints extent_of(const Prepared& prepared) {
  return prepared.pack ? packs::farthest_points(*prepared.pack)
                       : scenes::farthest_points(prepared.scene);
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
  const std::uint64_t other =
      kBase + prepared.pack->pages().size() * kBytesPerPage + pixels * kBytesPerPixel * ranks;
  const std::uint64_t left = budget.left();
  raster::PackMemory memory;
  // Blocks of the heap are never as full as they could be.
  memory.cache_bytes = std::max(left > other ? (left - other) / 4 * 3 / ranks : 0, kLeast);
  memory.fetch_threads = std::clamp(parallel::arena_threads(), 1, 16);
  return memory;
}

void take_scene(scenes::Scene&& scene, Prepared& prepared) {
  prepared.scene = std::move(scene);
  prepared.triangles = scenes::triangle_count(prepared.scene);
  prepared.points = scenes::splat_count(prepared.scene);
  prepared.vertices = scenes::vertex_count(prepared.scene);
}

// Loads the scene, or of one that comes in parts what is no geometry.
std::shared_ptr<Prepared> load(const RenderRequest& request, bool in_parts,
                               parallel::Progress* progress) {
  if (reads_pages(request)) {
    std::shared_ptr<Prepared> prepared = open_pack(request);
    if (request.engine == Engine::raster || !has_glow(prepared->scene)) return prepared;
  }
  if (request.raster.error > 0 || request.frame_milliseconds > 0) {
    const std::string& path = request.scene.file.path;
    const char* const option = request.raster.error > 0 ? "--error" : "--frame-time";
    throw UsageError(
        input_kind_of(request.scene.file) == InputKind::pack
            ? fmt::format("{}: {} is unpacked here, as sort-last and sort-first alone, without "
                          "--wall, --schedule and --blend by-cell, read a pack in parts",
                          option, path)
            : fmt::format("{} is for packs, whose levels it chooses from; {} is none", option,
                          path));
  }
  auto prepared = std::make_shared<Prepared>();
  prepared->in_parts = in_parts;
  prepared->known_by_name = has_parts(request);
  if (in_parts) {
    constexpr int kParts = 1 << 30;  // of which the first is nothing but camera and lights
    scenes::ScenePart part = scenes::generate_part(request.scene.file.path, 0, kParts);
    prepared->triangles = part.triangles;
    prepared->vertices = part.vertices;
    prepared->scene = std::move(part.scene);
  } else {
    take_scene(load_scene(request.scene, progress), *prepared);
  }
  pose_first(request.motion, request.scene.file.path, prepared->scene);
  return prepared;
}

void choose_cameras(const RenderRequest& request, const scenes::FarthestPoints& farthest,
                    Prepared& prepared) {
  constexpr int kTurns = 24;  // between two of them a point comes 0.9 % of its arm closer
  const scenes::Scene& scene = prepared.scene;
  const float aspect = static_cast<float>(request.width) / static_cast<float>(request.height);
  prepared.camera = choose_camera(request.camera, scene, farthest, aspect);
  glm::dvec3 pivot = prepared.camera.at;
  if (request.turntable > 0 && shows_all(request.camera, scene)) {
    const auto around =
        scenes::turned(farthest, prepared.camera.up, std::min(request.turntable, kTurns));
    prepared.camera = choose_camera(request.camera, scene, around, aspect);
    const geometry::Box3 box = scenes::bounds(farthest);
    pivot = (glm::dvec3(box.low) + glm::dvec3(box.high)) * 0.5;
  }
  prepared.camera_number = own_camera(request.camera, scene);
  prepared.cameras = animation_cameras(request, scene, prepared.camera, pivot);
  for (scenes::Camera& camera : prepared.cameras) set_lens(request.sampling, camera);
  set_lens(request.sampling, prepared.camera);
  if (!prepared.cameras.empty()) prepared.camera = prepared.cameras.front();
}

bool is_lit_by_emission(const Prepared& prepared) {
  return prepared.pack ? prepared.pack->lit_by_emission()
                       : scenes::is_lit_by_emission(prepared.scene);
}

// Says so where nothing but what glows lights a scene, which rasterizers do not see.
void warn_of_glow(const RenderRequest& request, const Prepared& prepared) {
  const scenes::Scene& scene = prepared.scene;
  if (request.engine != Engine::raster || !scene.lights.empty() || has_sky(scene.environment) ||
      !is_lit_by_emission(prepared)) {
    return;
  }
  spdlog::warn(
      "{}: lit by nothing but surfaces that glow, which light others only with --engine raytrace; "
      "--light default adds a key light and a sky",
      request.scene.file.path);
}

// The fingerprint of the scene that a checkpoint is for. Where the name tells what is in the scene,
// ranks may have parts of it.
std::string fingerprint_of(const RenderRequest& request, const Prepared& prepared) {
  if (!prepared.known_by_name) return raytrace::fingerprint(prepared.scene, "");
  scenes::Scene lights;  // which --light may have changed
  lights.lights = prepared.scene.lights;
  lights.environment = prepared.scene.environment;
  lights.textures = prepared.scene.textures;
  return raytrace::fingerprint(lights, request.scene.file.path);
}

// Completes the scene and builds what the engine needs. `watch` has run since loading began.
void build(const RenderRequest& request, Stopwatch& watch, Prepared& prepared) {
  load_light(request.light, request.scene.file.limits.budget(), prepared.scene);
  prepared.background = request.behind;
  if (prepared.background.kind == Background::Kind::automatic) {
    prepared.background.kind = has_sky(prepared.scene.environment) ? Background::Kind::environment
                                                                   : Background::Kind::studio;
  }
  if (request.legend && !prepared.scene.colour_scale) {
    throw UsageError(
        "--legend is for colours of height, intensity, classes or returns: see --color-by");
  }
  if (!prepared.pack) complete_surfaces(prepared.scene);
  if (request.engine == Engine::raytrace)
    scenes::set_radii_in_units(prepared.scene, prepared.camera, request.height);
  const bool is_lit = prepared.pack && prepared.pack->lit_by_emission();
  if (!is_lit || !request.light.light.empty())
    complete_light(request.light, prepared.camera, prepared.scene);
  warn_of_glow(request, prepared);
  prepared.load_seconds = watch.lap();
  require_memory_for_textures(request, prepared.scene);
  require_memory_for_pictures(request);
  prepared.texture_hash = texture_hash(prepared.scene);
  if (!request.sampling.checkpoint.empty())
    prepared.fingerprint = fingerprint_of(request, prepared);
  std::shared_ptr<shading::Shader> shader;
  std::unique_ptr<raytrace::Tracer> tracer;
  if (request.engine == Engine::raster) {
    shader = std::make_shared<shading::Shader>(shading::take_shader(prepared.scene));
  } else if (!is_replicated(request)) {
    shader = std::make_shared<shading::Shader>(shading::make_shader(prepared.scene));
  } else {
    require_memory_for_embree(request, prepared.scene);
    tracer = std::make_unique<raytrace::Tracer>(raytrace::make_tracer(
        prepared.scene, shading::take_shader(prepared.scene), request.raytrace.build));
  }
  if (request.motion.is_animation()) {
    prepared.motion = std::make_unique<MovingScene>(request.motion, request.scene.file.path,
                                                    prepared.scene, shader.get(), tracer.get());
  }
  prepared.shader = std::move(shader);
  prepared.tracer = std::move(tracer);
  prepared.build_seconds = watch.lap();
}

// What cameras around the scene show.
scenes::FarthestPoints seen_of(const RenderRequest& request, Prepared& prepared) {
  if (request.motion.is_animation() && shows_all(request.camera, prepared.scene))
    return farthest_in_motion(request.motion, request.scene.file.path, prepared.scene);
  return extent_of(prepared);
}

// The farthest points of all ranks' scenes; collective.
scenes::FarthestPoints of_all_ranks(comm::Communicator& communicator,
                                    const scenes::FarthestPoints& mine) {
  return [&communicator, &mine](std::span<const glm::dvec3> directions) {
    std::vector<glm::dvec3> farthest;
    const std::vector<glm::dvec3> own = mine(directions);
    for (const comm::Buffer& points :
         comm::all_gather(communicator, comm::Buffer::of(std::span<const glm::dvec3>(own)))) {
      const std::span<const glm::dvec3> candidates = points.as<glm::dvec3>();
      scenes::keep_farthest(directions, {candidates.begin(), candidates.end()}, farthest);
    }
    return farthest;
  };
}

}  // namespace

// Of sort-last every rank has a layer.
std::uint64_t picture_bytes_per_pixel(const RenderRequest& request, int ranks_here) {
  const std::uint64_t layer = wants_floats(request) ? sizeof(image::RgbaF) + sizeof(float)
                                                    : sizeof(image::Rgba8) + sizeof(float);
  const auto others = static_cast<std::uint64_t>(has_layers(request) ? ranks_here - 1 : 0);
  return bytes_per_pixel(request) + others * layer;
}

std::shared_ptr<const Prepared> prepare(const RenderRequest& request,
                                        parallel::Progress* progress) {
  Stopwatch watch;
  const bool in_parts = comes_in_parts(request) && request.camera.view.empty();
  const std::shared_ptr<Prepared> prepared = load(request, in_parts, progress);
  choose_cameras(request, seen_of(request, *prepared), *prepared);
  build(request, watch, *prepared);
  return prepared;
}

std::shared_ptr<const Prepared> prepare(const RenderRequest& request, scenes::Scene&& scene) {
  Stopwatch watch;
  const auto prepared = std::make_shared<Prepared>();
  take_scene(std::move(scene), *prepared);
  choose_cameras(request, extent_of(*prepared), *prepared);
  build(request, watch, *prepared);
  return prepared;
}

std::shared_ptr<const Prepared> prepare(comm::Communicator& communicator,
                                        const RenderRequest& request,
                                        parallel::Progress* progress) {
  const auto on_all = [&](auto&& step) {
    comm::all_or_none(communicator, comm::Phase::load, step);
  };
  Stopwatch watch;
  std::shared_ptr<Prepared> prepared;
  scenes::ScenePart part;
  on_all([&] {
    prepared = load(request, comes_in_parts(request), progress);
    if (!prepared->in_parts || request.camera.view.empty()) return;
    part = scenes::generate_part(request.scene.file.path, communicator.rank(), communicator.size());
  });
  if (prepared->in_parts && !request.camera.view.empty()) {
    const scenes::FarthestPoints mine = scenes::farthest_points(part.scene);
    choose_cameras(request, of_all_ranks(communicator, mine), *prepared);
    part = {};
  } else {
    on_all([&] { choose_cameras(request, seen_of(request, *prepared), *prepared); });
  }
  on_all([&] { build(request, watch, *prepared); });
  return prepared;
}

FrameRenderer::FrameRenderer(comm::Communicator& communicator, const Prepared& prepared,
                             const RenderRequest& request, parallel::Progress* progress)
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
    raster_.emplace(*prepared.pack, prepared.scene, pack_memory(request, prepared),
                    prepared.shader);
    return;
  }
  if (request.engine == Engine::raster) {
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
  if (prepared_.in_parts) {
    scenes::ScenePart part =
        scenes::generate_part(request_.scene.file.path, communicator.rank(), communicator.size());
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
  RayFrame done =
      render_rays(communicator, *raytrace_, prepared_, request, camera, options, preview_);
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
  FrameRenderer renderer(communicator, prepared, request, progress);
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
