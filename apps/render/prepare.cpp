// Loads a scene, whole or this rank's part, chooses cameras, completes light and surfaces, and
// builds what the engine needs, with checks of memory before it is taken.
//
// Scenes in parts are prepared on every rank without geometry; cameras that show all of it are
// agreed upon by the farthest points of all ranks.
#include "apps/render/prepare.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "apps/render/animation.h"
#include "apps/render/bands.h"
#include "apps/render/scene_facts.h"
#include "apps/statistics.h"
#include "comm/agree_on_failure.h"
#include "comm/collectives.h"
#include "packs/extent.h"
#include "raster/strategies.h"
#include "raytrace/checkpoint.h"
#include "scenes/framing.h"
#include "scenes/generate.h"
#include "scenes/load_part.h"
#include "scenes/points.h"
#include "shading/take_shader.h"

namespace delray::apps {
namespace {

// Whether the scene itself says what is to be seen around it.
bool has_sky(const scenes::Environment& environment) {
  return environment.texture != scenes::kNone ||
         environment.zenith + environment.horizon + environment.ground != glm::vec3(0.0F);
}

void set_lens(const SamplingOptions& sampling, scenes::Camera& camera) {
  camera.aperture = static_cast<float>(sampling.aperture);
  camera.focus = static_cast<float>(sampling.focus);
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

// Whether each of several ranks that share no memory may read a part of a scene's file: the engine
// renders parts, and no option asks for something of the whole, as poses and levels of packs are.
bool reads_part(const RenderRequest& request, int ranks) {
  const SceneInput& input = request.scene;
  const raster::RenderOptions& options = request.raster;
  const bool renders_parts = request.engine == Engine::raytrace
                                 ? !is_replicated(request)
                                 : raster::find_strategy(options.strategy)->parts &&
                                       options.groups == raster::Groups::one &&
                                       options.blend == raster::Blend::by_owner;
  const bool moves = request.motion.is_animation() || !request.motion.pose_time.empty();
  const bool has_levels = options.error > 0 || request.frame_milliseconds > 0;
  return ranks > 1 && renders_parts && !moves && !has_levels &&
         request.sampling.checkpoint.empty() && !request.legend &&
         !scenes::is_generated(input.file.path) && is_plain(input) &&
         input_kind_of(input.file) == InputKind::scene;
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
  RenderRequest as_tiff = request;
  as_tiff.output = "a.tif";
  const bool has_bands = !comes_in_bands(request) && comes_in_bands(as_tiff);
  request.scene.file.limits.budget().require(
      pixels * picture_bytes_per_pixel(request, ranks) + writer_bytes(request.output),
      request.output,
      fmt::format("{} x {} pixels{}{}", request.picture_width(), request.picture_height(),
                  writer_bytes(request.output) > 0 ? " and the libraries that write them" : "",
                  has_bands ? " (as .tif or .exr they would be written in bands)" : ""));
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
    return data.reads_packs() && request.sampling.checkpoint.empty();
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
  prepared->triangles = pack->triangles();
  prepared->points = pack->splats();
  prepared->vertices = pack->vertices();
  prepared->pack = std::move(pack);
  return prepared;
}

// This rank's part of a file; null, on all ranks, where it is not read in parts. Collective.
std::shared_ptr<Prepared> load_part(comm::Communicator& communicator,
                                    const RenderRequest& request) {
  const InputLimits& limits = request.scene.file.limits;
  std::vector<std::string> warnings;
  std::optional<scenes::ScenePart> part =
      scenes::load_part(communicator, request.scene.file.path, warnings,
                        {.memory = limits.budget(), .outside = limits.outside()});
  if (!part) return nullptr;
  for (const std::string& warning : warnings) spdlog::warn(warning);
  auto prepared = std::make_shared<Prepared>();
  prepared->triangles = part->triangles;
  prepared->vertices = part->vertices;
  prepared->scene = std::move(part->scene);
  if (!request.scene.up.empty()) prepared->scene.z_up = request.scene.up == "z";
  scenes::Scene geometry;
  geometry.meshes = std::exchange(prepared->scene.meshes, {});
  geometry.instances = std::exchange(prepared->scene.instances, {});
  geometry.materials = prepared->scene.materials;
  geometry.framed = prepared->scene.framed;
  part->scene = std::move(geometry);
  prepared->part = std::make_unique<scenes::ScenePart>(*std::move(part));
  return prepared;
}

scenes::FarthestPoints extent_of(const Prepared& prepared) {
  return prepared.pack ? packs::farthest_points(*prepared.pack)
                       : scenes::farthest_points(prepared.scene);
}

void take_scene(scenes::Scene&& scene, Prepared& prepared) {
  prepared.scene = std::move(scene);
  prepared.triangles = scenes::triangle_count(prepared.scene);
  prepared.points = scenes::splat_count(prepared.scene);
  prepared.vertices = scenes::vertex_count(prepared.scene);
}

// Loads the scene, or of one that comes in parts what is no geometry.
std::shared_ptr<Prepared> load(const RenderRequest& request, bool in_parts,
                               parallel::Progress* progress, const PrepareOptions& options) {
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
    LoadedScene loaded = load_scene_and_points(request.scene, progress, options.preview);
    if (options.keep_points) prepared->file_points = std::move(loaded.points);
    take_scene(std::move(loaded.scene), *prepared);
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
  for (scenes::Camera& camera : prepared.cameras) {
    set_lens(request.sampling, camera);
    set_clip(request.camera, camera);
  }
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
    prepared.lit_by_default = complete_light(request.light, prepared.camera, prepared.scene);
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

void add_tracer(const RenderRequest& request, Prepared& prepared) {
  require_memory_for_embree(request, prepared.scene);
  // Rays want radii in units; what the rasterizer draws stays as it is.
  std::vector<scenes::Shape> shapes;
  for (const scenes::Mesh& mesh : prepared.scene.meshes) shapes.push_back(mesh.shape);
  scenes::set_radii_in_units(prepared.scene, prepared.camera, request.height);
  prepared.tracer = std::make_unique<raytrace::Tracer>(
      raytrace::make_tracer(prepared.scene, *prepared.shader, request.raytrace.build));
  for (std::size_t i = 0; i < shapes.size(); ++i) prepared.scene.meshes[i].shape = shapes[i];
}

void follow_camera(const RenderRequest& request, const scenes::Camera& camera, Prepared& prepared) {
  if (!prepared.lit_by_default) return;
  scenes::Scene& scene = prepared.scene;
  scene.lights.pop_back();
  scenes::add_default_light(scene, camera, static_cast<float>(request.light.strength));
  prepared.shader->lights = scene.lights;
  scenes::Movement movement;
  movement.lights = true;
  if (prepared.tracer) raytrace::follow(*prepared.tracer, scene, movement);
}

bool wants_floats(const RenderRequest& request) {
  return image::picture_suffix(request.output) == ".exr";
}

// Of sort-last every rank has a layer.
std::uint64_t picture_bytes_per_pixel(const RenderRequest& request, int ranks_here) {
  const std::uint64_t layer = wants_floats(request) ? sizeof(image::RgbaF) + sizeof(float)
                                                    : sizeof(image::Rgba8) + sizeof(float);
  const auto others = static_cast<std::uint64_t>(has_layers(request) ? ranks_here - 1 : 0);
  return bytes_per_pixel(request) + others * layer;
}

std::shared_ptr<Prepared> prepare(const RenderRequest& request, parallel::Progress* progress,
                                  const PrepareOptions& options) {
  Stopwatch watch;
  const bool in_parts = comes_in_parts(request) && request.camera.view.empty();
  std::shared_ptr<Prepared> prepared = load(request, in_parts, progress, options);
  choose_cameras(request, seen_of(request, *prepared), *prepared);
  build(request, watch, *prepared);
  return prepared;
}

std::shared_ptr<Prepared> prepare(const RenderRequest& request, scenes::Scene&& scene) {
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
    return comm::all_or_none(communicator, comm::Phase::load, step);
  };
  Stopwatch watch;
  std::shared_ptr<Prepared> prepared;
  if (on_all([&] { return reads_part(request, communicator.size()); }))
    prepared = load_part(communicator, request);
  scenes::ScenePart made;
  if (!prepared) {
    on_all([&] {
      prepared = load(request, comes_in_parts(request), progress, {});
      if (!prepared->in_parts || request.camera.view.empty()) return;
      made =
          scenes::generate_part(request.scene.file.path, communicator.rank(), communicator.size());
    });
  }
  if (prepared->part || (prepared->in_parts && !request.camera.view.empty())) {
    const scenes::FarthestPoints mine =
        scenes::farthest_points(prepared->part ? prepared->part->scene : made.scene);
    // What is wrong with the options is found before anybody waits for others.
    on_all([&] { choose_cameras(request, mine, *prepared); });
    choose_cameras(request, of_all_ranks(communicator, mine), *prepared);
    made = {};
  } else {
    on_all([&] { choose_cameras(request, seen_of(request, *prepared), *prepared); });
  }
  on_all([&] { build(request, watch, *prepared); });
  return prepared;
}

}  // namespace delray::apps
