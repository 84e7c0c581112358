// Frames: the committed camera, renderer and world through Delray's renderers. With a communicator
// every rank draws its own world, and images are composited: opaque ones by depth, others surface
// by surface.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

#include "c/delray.h"
#include "c/frame_picture.h"
#include "c/frame_state.h"
#include "c/guard.h"
#include "c/object.h"
#include "c/world_scene.h"
#include "comm/agree_on_failure.h"
#include "comm/collectives.h"
#include "comm/mpi.h"
#include "comm/threads.h"
#include "composite/compose_images.h"
#include "composite/deep.h"
#include "composite/flatten.h"
#include "image/srgb.h"
#include "parallel/arena.h"
#include "parallel/parallel_for.h"
#include "shading/shader.h"

namespace delray::c {
namespace {

using image::Image8;
using image::ImageF;

constexpr float kDegrees = 57.29577951308232F;

scenes::Camera camera_of(const DelrayObject_& object) {
  scenes::Camera camera;
  const auto vector = [&](const char* name, const glm::vec3& otherwise) {
    const glm::vec3 v = object.value(name, otherwise);
    if (!std::isfinite(glm::dot(v, v)))
      throw std::invalid_argument(std::string("DELRAY_CAMERA: ") + name + " is not finite");
    return v;
  };
  const auto number = [&](const char* name, float otherwise, float above, float below) {
    const float x = object.value(name, otherwise);
    if (!(x >= above && x < below))
      throw std::invalid_argument(std::string("DELRAY_CAMERA: ") + name + " is out of range");
    return x;
  };
  constexpr float kFar = 1e18F;
  const glm::vec3 direction = vector("direction", {0, 0, -1});
  camera.eye = vector("position", glm::vec3(0.0F));
  camera.at = camera.eye + direction;
  camera.up = vector("up", {0, 1, 0});
  camera.near = number("near", 0.0F, 0.0F, kFar);
  if (object.subtype == "orthographic") {
    camera.height = number("height", 1.0F, 1e-18F, kFar);
    camera.far = number("far", 1e6F, camera.near, kFar);
  } else {
    camera.vertical_fov = number("fovy", 1.0471976F, 1e-4F, 3.1415F) * kDegrees;
    camera.aperture = 2.0F * number("apertureRadius", 0.0F, 0.0F, kFar);
    camera.focus = number("focusDistance", 1.0F, 1e-18F, kFar);
    if (camera.near == 0.0F) camera.near = 1e-3F * std::max(1e-15F, glm::length(direction));
  }
  return camera;
}

Task task_of(const DelrayObject_& frame) {
  const auto part = [&](const char* name) {
    const DelrayObject object = frame.object(name);
    if (object == nullptr)
      throw std::invalid_argument(std::string("DELRAY_FRAME: ") + name + " is missing");
    return object;
  };
  Task task;
  task.world = part("world");
  task.camera = part("camera");
  task.renderer = part("renderer");
  const glm::uvec2 size = frame.value("size", glm::uvec2(0));
  constexpr std::uint32_t kMostSide = 32768;
  if (size.x < 1 || size.y < 1 || size.x > kMostSide || size.y > kMostSide)
    throw std::invalid_argument("DELRAY_FRAME: size is not from 1 to 32768 in either direction");
  task.width = static_cast<int>(size.x);
  task.height = static_cast<int>(size.y);
  task.colour = frame.value("channel.color", DELRAY_UNKNOWN);
  task.depth = frame.value("channel.depth", DELRAY_UNKNOWN);
  if (task.colour != DELRAY_UNKNOWN && task.colour != DELRAY_UFIXED8_VEC4 &&
      task.colour != DELRAY_UFIXED8_RGBA_SRGB && task.colour != DELRAY_FLOAT32_VEC4) {
    throw std::invalid_argument("DELRAY_FRAME: channel.color cannot be " + name_of(task.colour));
  }
  if (task.depth != DELRAY_UNKNOWN && task.depth != DELRAY_FLOAT32)
    throw std::invalid_argument("DELRAY_FRAME: channel.depth cannot be " + name_of(task.depth));
  task.is_raytrace = task.renderer->subtype == "raytrace";
  task.samples = task.renderer->value("pixelSamples", 1);
  constexpr int kMostSamples = 65536;
  if (task.samples < 1 || task.samples > kMostSamples)
    throw std::invalid_argument("DELRAY_RENDERER: pixelSamples is not from 1 to 65536");
  task.view = camera_of(*task.camera);
  // What `aspect` says of pixels that are no squares is not rendered.
  const float aspect = task.camera->value(
      "aspect", static_cast<float>(task.width) / static_cast<float>(task.height));
  if (std::abs(aspect * static_cast<float>(task.height) / static_cast<float>(task.width) - 1.0F) >
      0.01F)
    throw std::invalid_argument("DELRAY_CAMERA: aspect is not that of the frame");
  return task;
}

void add_ambient(const DelrayObject_& renderer, scenes::Scene& scene) {
  const float radiance = renderer.value("ambientRadiance", 0.0F);
  const glm::vec3 colour = renderer.value("ambientColor", glm::vec3(1.0F)) * radiance;
  if (!(radiance >= 0.0F && radiance < 1e9F) || !(glm::dot(colour, colour) < 1e18F))
    throw std::invalid_argument(
        "DELRAY_RENDERER: ambientRadiance times ambientColor is out of range");
  scene.environment.zenith = scene.environment.horizon = scene.environment.ground = colour;
}

// The scene of the last frame where nothing of it has changed. The renderer's ambient light is part
// of it, and cheap to compare.
Built& built_for(const DelrayObject_& frame, const Task& task) {
  FrameState& state = *frame.frame;
  scenes::Scene light;
  add_ambient(*task.renderer, light);
  const bool is_same = state.built && state.built->world == task.world &&
                       state.built->scene_changes == frame.device->scene_changes &&
                       state.built->is_raytrace == task.is_raytrace &&
                       state.built->scene.environment.zenith == light.environment.zenith;
  if (is_same) return *state.built;
  state.built.reset();
  auto built = std::make_unique<Built>();
  built->world = task.world;
  built->scene_changes = frame.device->scene_changes;
  built->is_raytrace = task.is_raytrace;
  built->scene = scene_of(*task.world);
  built->scene.environment = light.environment;
  built->is_transparent =
      std::ranges::any_of(built->scene.materials, [](const scenes::Material& m) {
        return m.alpha == scenes::Material::Alpha::blend || m.transmission > 0.0F;
      });
  complete_surfaces(built->scene);
  if (task.is_raytrace) {
    built->tracer = std::make_unique<const raytrace::Tracer>(raytrace::make_tracer(built->scene));
  } else {
    built->raster = std::make_unique<raster::Renderer>(built->scene);
  }
  state.built = std::move(built);
  return *state.built;
}

raster::RenderOptions raster_options(const Task& task) {
  raster::RenderOptions options;
  options.width = task.width;
  options.height = task.height;
  options.float_pixels = task.colour == DELRAY_FLOAT32_VEC4;
  options.supersampling = task.samples >= 16 ? 4 : task.samples >= 4 ? 2 : 1;
  return options;
}

ImageF trace(comm::Communicator& alone, const Built& built, const Task& task) {
  raytrace::RenderOptions options;
  options.width = task.width;
  options.height = task.height;
  options.samples = task.samples;
  options.integrator = task.renderer->text("integrator", "whitted");
  options.trace.depth = std::clamp(task.renderer->value("maxDepth", 8), 0, 64);
  options.trace.background = raytrace::TraceOptions::Background::transparent;
  return raytrace::render(alone, *built.tracer, task.view, options).image;
}

raster::Picture draw(comm::Communicator& alone, Built& built, const Task& task) {
  if (task.is_raytrace) return trace(alone, built, task);
  return built.raster->render(alone, task.view, raster_options(task)).picture;
}

// All surfaces of this rank, told apart from those of others.
composite::DeepImage<image::RgbaF> surfaces(const Built& built, const Task& task,
                                            std::uint32_t rank) {
  raster::PartialImage share = built.raster->draw_share(0, 1, task.view, raster_options(task));
  if (auto* deep = std::get_if<composite::DeepImage<image::RgbaF>>(&share)) {
    for (auto& chunk : deep->chunks) {
      for (composite::Fragment& fragment : chunk) fragment.primitive_high = rank;
    }
    return std::move(*deep);
  }
  // Its depths are distances along the view axis, those of surfaces are not.
  const scenes::View view = make_view(task.view, task.width, task.height);
  const auto depth_at = [&view](float distance) {
    return view.orthographic ? (distance - view.far) / (view.far - view.near)
                             : -view.near / distance;
  };
  const Image8& opaque = std::get<Image8>(share);
  std::vector<composite::DeepTile<image::RgbaF>> tiles(1);
  for (std::size_t i = 0; i < opaque.pixels(); ++i) {
    if (opaque.depth[i] == image::kEmptyDepth) continue;
    tiles[0].pixels.push_back({i, 1});
    tiles[0].fragments.push_back(
        {image::to_float(opaque.colour[i]), depth_at(opaque.depth[i]), 0, rank});
  }
  return {task.width, task.height, std::move(tiles)};
}

raster::Picture blend_all(comm::Communicator& ranks, const Built& built, const Task& task,
                          const std::string& scheme) {
  auto layer =
      composite::make_deep(surfaces(built, task, static_cast<std::uint32_t>(ranks.rank())));
  composite::OwnedPixels part =
      composite::gather(ranks, composite::compose(ranks, std::move(layer), scheme), 0);
  if (ranks.rank() != 0) return Image8();
  ImageF whole =
      composite::flatten<image::RgbaF>(composite::take_deep<image::RgbaF>(std::move(part)));
  // From the rasterizer's unit to distances along the view axis.
  const scenes::View view = make_view(task.view, task.width, task.height);
  for (float& depth : whole.depth.span()) {
    if (depth == image::kEmptyDepth) continue;
    depth = view.orthographic ? view.far + depth * (view.far - view.near) : -view.near / depth;
  }
  return whole;
}

// Collective.
raster::Picture draw_with(comm::Communicator& ranks, const DelrayObject_& frame, const Task& task) {
  Built* built = nullptr;
  comm::all_or_none(ranks, comm::Phase::load, [&] {
    if (task.is_raytrace)
      throw std::invalid_argument(
          "DELRAY_RENDERER raytrace: rays do not meet what other ranks have; use default with "
          "mpiCommunicator");
    if (task.samples > 1)
      throw std::invalid_argument("DELRAY_RENDERER: pixelSamples is 1 with mpiCommunicator");
    built = &built_for(frame, task);
  });
  const int any_transparent = comm::all_reduce_value(ranks, built->is_transparent ? 1 : 0,
                                                     [](int a, int b) { return std::max(a, b); });
  const std::string scheme = task.renderer->text("compositing", "radix-k");
  if (any_transparent != 0) return blend_all(ranks, *built, task, scheme);
  composite::ImageOptions options;
  options.scheme = scheme;
  raster::Picture mine;
  comm::run_threads(1, frame.device->threads,
                    [&](comm::Communicator& alone) { mine = draw(alone, *built, task); });
  return std::visit(
      [&](auto&& image) -> raster::Picture {
        return composite::compose_images(ranks, std::move(image), options);
      },
      std::move(mine));
}

void render(DelrayObject_& frame) {
  FrameState& state = *frame.frame;
  const auto begin = std::chrono::steady_clock::now();
  const void* const mpi = frame.value<const void*>("mpiCommunicator", nullptr);
  const parallel::AllowThreads allowed(frame.device->threads);
  parallel::Arena arena(frame.device->threads);
  raster::Picture picture;
  Task task;
  if (mpi != nullptr) {
    if (state.mpi_communicator != mpi || !state.ranks) {
      state.ranks.reset();
      state.ranks = comm::make_mpi_communicator(mpi);
      state.mpi_communicator = mpi;
    }
    comm::all_or_none(*state.ranks, comm::Phase::load, [&] { task = task_of(frame); });
    picture = arena.execute([&] { return draw_with(*state.ranks, frame, task); });
  } else {
    task = task_of(frame);
    Built& built = arena.execute([&]() -> Built* { return &built_for(frame, task); })[0];
    comm::run_threads(1, frame.device->threads,
                      [&](comm::Communicator& alone) { picture = draw(alone, built, task); });
  }
  arena.execute([&] { keep(std::move(picture), task, state); });
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  state.seconds = seconds.count();
  state.samples = task.samples;
}

bool property(DelrayObject_& object, std::string_view name, DelrayDataType type, void* memory,
              std::uint64_t size) {
  const auto give = [&](DelrayDataType of, const auto& value) {
    if (type != of || size != sizeof(value)) return false;
    std::memcpy(memory, &value, sizeof(value));
    return true;
  };
  if (object.kind == DELRAY_WORLD && name == "bounds") {
    const geometry::Box3 box = scenes::bounds(scene_of(object));
    const float corners[6] = {box.low.x, box.low.y, box.low.z, box.high.x, box.high.y, box.high.z};
    return give(DELRAY_FLOAT32_BOX3, corners);
  }
  if (object.kind == DELRAY_FRAME && object.frame->samples > 0) {
    if (name == "duration") return give(DELRAY_FLOAT32, static_cast<float>(object.frame->seconds));
    if (name == "numSamples") return give(DELRAY_INT32, std::int32_t{object.frame->samples});
  }
  return false;
}

}  // namespace
}  // namespace delray::c

using delray::c::guarded;
using delray::c::guarded_value;
using delray::c::require;

extern "C" {

int delrayGetProperty(DelrayDevice device, DelrayObject object, const char* name,
                      DelrayDataType type, void* memory, uint64_t size) {
  return guarded_value([&]() -> int {
    require(device, "device");
    require(object, "object");
    require(name, "name");
    require(memory, "memory");
    const std::scoped_lock lock(device->mutex);
    return delray::c::property(*object, name, type, memory, size) ? 1 : 0;
  });
}

DelrayStatus delrayRenderFrame(DelrayDevice device, DelrayFrame frame) {
  return guarded([&] {
    require(device, "device");
    require(frame, "frame");
    const std::scoped_lock lock(device->mutex);
    if (frame->kind != DELRAY_FRAME) throw std::invalid_argument("the object is no DELRAY_FRAME");
    delray::c::render(*frame);
  });
}

int delrayFrameReady(DelrayDevice device, DelrayFrame frame, DelrayWaitMask) {
  return guarded_value([&]() -> int {
    require(device, "device");
    require(frame, "frame");
    const std::scoped_lock lock(device->mutex);
    return frame->kind == DELRAY_FRAME && frame->frame->samples > 0 ? 1 : 0;
  });
}

const void* delrayMapFrame(DelrayDevice device, DelrayFrame frame, const char* channel,
                           uint32_t* width, uint32_t* height, DelrayDataType* type) {
  return guarded_value([&]() -> const void* {
    require(device, "device");
    require(frame, "frame");
    require(channel, "channel");
    require(width, "width");
    require(height, "height");
    require(type, "type");
    const std::scoped_lock lock(device->mutex);
    if (frame->kind != DELRAY_FRAME) throw std::invalid_argument("the object is no DELRAY_FRAME");
    const delray::c::FrameState& state = *frame->frame;
    const std::string_view name = channel;
    const void* pixels = nullptr;
    DelrayDataType of = DELRAY_FLOAT32;
    if (name == "channel.color") {
      of = frame->value("channel.color", DELRAY_UNKNOWN);
      pixels = state.light.size() > 0 ? static_cast<const void*>(state.light.data())
                                      : static_cast<const void*>(state.codes.data());
    } else if (name == "channel.depth") {
      pixels = state.depth.data();
    }
    if (pixels == nullptr)
      throw std::invalid_argument("the frame has no '" + std::string(name) + "' here");
    *width = static_cast<std::uint32_t>(state.width);
    *height = static_cast<std::uint32_t>(state.height);
    *type = of;
    return pixels;
  });
}

void delrayUnmapFrame(DelrayDevice, DelrayFrame, const char*) {}

}  // extern "C"
