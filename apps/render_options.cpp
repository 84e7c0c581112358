#include "apps/render_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <charconv>
#include <initializer_list>

#include "apps/list.h"
#include "apps/numbers.h"
#include "apps/scheme_option.h"
#include "composite/codec.h"
#include "image/io.h"
#include "loadbalance/partition.h"
#include "loadbalance/schedule.h"
#include "raster/strategies.h"
#include "raytrace/distribution.h"
#include "raytrace/integrator.h"

namespace delray::apps {
namespace {

constexpr int kLargestSide = 32768;

// Throws UsageError if one of the options was given.
void refuse(const CLI::App& command, std::initializer_list<const char*> options,
            const std::string& with) {
  for (const char* option : options) {
    if (command.count(option) > 0) {
      throw UsageError(fmt::format("{} has no effect with {}", option, with));
    }
  }
}

bool is_jpeg(std::string path) {
  std::ranges::transform(path, path.begin(), [](unsigned char c) { return std::tolower(c); });
  return path.ends_with(".jpg") || path.ends_with(".jpeg");
}

// Throws UsageError if --master was given and no rank is one.
void check_master(const CLI::App& command, const std::string& schedule) {
  if (schedule != "demand" && schedule != "guided" && schedule != "hierarchical")
    refuse(command, {"--master"}, schedule.empty() ? "no --schedule" : "--schedule " + schedule);
}

void check_raster(const CLI::App& command, const RenderRequest& request) {
  refuse(command,
         {"--integrator", "--spp", "--depth", "--diffuse-depth", "--reach", "--no-shadows",
          "--build", "--isa", "--data", "--deal", "--cache"},
         "--engine raster");
  refuse_practice(command);
  if (request.strategy == "sort-last") {
    refuse(command, {"--partition", "--travel", "--costs", "--regions", "--keep"},
           "--strategy sort-last");
  } else {
    refuse(command, {"--compose", "--codec", "--blend"}, "--strategy " + request.strategy);
  }
  if (request.strategy == "sort-first") {
    if (!request.schedule.empty()) {
      refuse(command, {"--travel"}, "--schedule: every rank has all primitives");
    } else {
      refuse(command, {"--block"}, "no --schedule");
    }
  } else {
    refuse(command, {"--schedule", "--block"}, "--strategy " + request.strategy);
  }
  check_master(command, request.schedule);
  if (request.strategy == "sort-middle") {
    refuse(command, {"--travel"}, "--strategy sort-middle: triangles travel");
    if (request.groups == "one") refuse(command, {"--geometry-ranks"}, "--groups one");
  } else {
    refuse(command, {"--groups", "--geometry-ranks", "--redistribute"},
           "--strategy " + request.strategy);
  }
  if (request.shade == "composited") {
    if (request.strategy != "sort-last") {
      throw UsageError("--shade composited: only --strategy sort-last composites");
    }
    if (request.lighting == "gouraud") {
      throw UsageError("--shade composited: vertices are lit before with --shading gouraud");
    }
    refuse(command, {"--codec", "--blend"}, "--shade composited");
  }
}

void check_raytrace(const CLI::App& command, RenderRequest& request) {
  if (request.schedule.empty()) request.schedule = "interlaced";
  refuse(command,
         {"--strategy", "--compose", "--codec", "--shading", "--shade", "--blend", "--samples",
          "--travel", "--groups", "--geometry-ranks", "--redistribute"},
         "--engine raytrace");
  if (request.integrator != "ao") refuse(command, {"--reach"}, "another --integrator than ao");
  if (request.integrator != "direct")
    refuse(command, {"--no-shadows"}, "another --integrator than direct");
  if (request.integrator != "path")
    refuse(command, {"--diffuse-depth"}, "another --integrator than path");
  check_practice(command, request);
  check_master(command, request.schedule);
  if (request.data == "replicated") refuse(command, {"--deal", "--cache"}, "--data replicated");
  if (request.data == "ray" || request.data == "ring")
    refuse(command, {"--cache"}, "--data " + request.data + ": rays travel");
  if (command.count("--block") == 0) request.block = raytrace::integrator(request.integrator).side;
  if (request.block % raytrace::kTaskSide != 0) {
    throw UsageError(
        fmt::format("--block: the ray tracer's are a multiple of {} pixels", raytrace::kTaskSide));
  }
  if (command.count("--partition") == 0) {
    refuse(command, {"--costs", "--regions", "--keep"}, "no --partition");
    request.partition.clear();
    return;
  }
  if (request.schedule != "static" && !request.schedule.ends_with("stealing")) {
    refuse(command, {"--partition"},
           fmt::format("--schedule {}, which begins with no shares", request.schedule));
  }
}

void add_choices(CLI::App& command) {
  choose_from(command, "--background", background_names(),
              {"#rrggbb", [](const std::string& text) { return text.starts_with('#'); }});
  choose_from(command, "--strategy", names_in(raster::strategies()));
  choose_from(command, "--partition", names_in(loadbalance::partitioners()));
  choose_scheme(command);
  choose_from(command, "--codec", names_in(composite::codecs()));
  choose_from(command, "--integrator", names_in(raytrace::integrators()));
  choose_from(command, "--schedule", names_in(loadbalance::schedules()));
  choose_from(command, "--data", names_in(raytrace::distributions()));
}

}  // namespace

void parse_size(RenderRequest& request) {
  const char* const end = request.size.data() + request.size.size();
  const auto [x, error] = std::from_chars(request.size.data(), end, request.width);
  const bool fine = error == std::errc() && x != end && *x == 'x' &&
                    std::from_chars(x + 1, end, request.height).ptr == end;
  if (!fine || request.width < 1 || request.height < 1 || request.width > kLargestSide ||
      request.height > kLargestSide) {
    throw UsageError(fmt::format("--size: '{}' is not WIDTHxHEIGHT, each from 1 to {}",
                                 request.size, kLargestSide));
  }
}

void add_render_options(CLI::App& command, RenderRequest& request) {
  add_scene_options(command, request.scene);
  command.add_option("-o,--output", request.output, "the picture: .png .exr .tif .jpg");
  command.add_option("--size", request.size, "WIDTHxHEIGHT (default 1280x720)");
  command.add_option("--engine", request.engine, "raster (default) or raytrace")
      ->check(one_of({"raster", "raytrace"}));
  command
      .add_option("--frames", request.frames,
                  "render so often and report the median time (default 1)")
      ->transform(count_between(1, 100000));
  command.add_option("--background", request.background,
                     "auto (default), environment, studio, transparent or #rrggbb");
  add_camera_options(command, request.camera);
  command
      .add_option("--turntable", request.turntable,
                  "an animation once around the scene: so many frames, IMAGE-0000 and on")
      ->transform(count_between(1, 1000000))
      ->excludes("--frames");
  command
      .add_option("--camera-path", request.camera_path,
                  "an animation along cameras in a file, a line each: [FRAME:] eye,at,up,fov")
      ->excludes("--frames")
      ->excludes("--turntable")
      ->excludes("--camera")
      ->excludes("--view");
  command
      .add_option("--frames-at-once", request.frames_at_once,
                  "of an animation that are in the making at the same time (default: threads + 2, "
                  "from 4 to 8); 1: one after the other")
      ->transform(count_between(1, 64));
  add_launch_options(command, request.launch);
  const std::string raster = "Rasterizer";
  command.add_option("--strategy", request.strategy, "how ranks share the work")->group(raster);
  command
      .add_option("--partition", request.partition,
                  "of the screen: sort-first, sort-middle; what ray tracing ranks begin with")
      ->group(raster);
  command.add_option("--compose", request.scheme, "compositing scheme, sort-last")->group(raster);
  command.add_option("--shading", request.lighting, "phong (default) or gouraud")
      ->check(one_of({"phong", "gouraud"}))
      ->group(raster);
  command.add_option("--codec", request.codec, "how pixels travel, sort-last")->group(raster);
  command
      .add_option("--blend", request.blend,
                  "transparent surfaces: by-owner (of the pixel, exactly; default), or by-cell: "
                  "each rank those in its cell of space, then front to back; sort-last")
      ->check(one_of({"by-owner", "by-cell"}))
      ->group(raster);
  command
      .add_option("--shade", request.shade,
                  "pixels: deferred (default), immediate, or composited (once ranks are)")
      ->check(one_of({"deferred", "immediate", "composited"}))
      ->group(raster);
  command
      .add_option("--samples", request.supersampling,
                  "per pixel, in either direction: 1 (default), 2 or 4")
      ->check(one_of({"1", "2", "4"}))
      ->group(raster);
  command
      .add_option("--travel", request.travel,
                  "primitives as geometry (default) or numbers, where they change rank")
      ->check(one_of({"geometry", "numbers"}))
      ->group(raster);
  command
      .add_option("--costs", request.costs,
                  "what partitions go by: model (default; rays counted in the last frame), or "
                  "measured in the last frame")
      ->check(one_of({"model", "measured"}))
      ->group(raster);
  command
      .add_option("--regions", request.regions_per_rank, "of the screen, for each rank (default 1)")
      ->transform(count_between(1, 64))
      ->group(raster);
  command
      .add_option("--keep", request.keep_factor,
                  "keep the last frame's partition while no rank does more than so many times an "
                  "equal share (default 1.2)")
      ->check(number_between(1.0, 1000.0))
      ->group(raster);
  command
      .add_option("--block", request.block,
                  "pixels, the side of a block that --schedule hands out (default 64; with rays a "
                  "multiple of 16, by default 32 of path, else 16)")
      ->transform(count_between(1, 4096))
      ->group(raster);
  command
      .add_option("--groups", request.groups,
                  "sort-middle: ranks do both halves (one, default), or some geometry and the "
                  "others pixels (two)")
      ->check(one_of({"one", "two"}))
      ->group(raster);
  command
      .add_option("--geometry-ranks", request.geometry_ranks,
                  "sort-middle, two groups: how many ranks do geometry (default half)")
      ->transform(count_between(1, 1000000))
      ->group(raster);
  command
      .add_option(
          "--redistribute", request.redistribution,
          "sort-middle: triangles are sent in batches at once (immediate, default) or at-end")
      ->check(one_of({"immediate", "at-end"}))
      ->group(raster);
  const std::string raytrace = "Ray tracer";
  command.add_option("--integrator", request.integrator, "what rays do")->group(raytrace);
  command.add_option("--spp", request.samples, "samples per pixel (default 1)")
      ->transform(count_between(1, 65536))
      ->group(raytrace);
  command.add_option("--depth", request.depth, "maximum reflections and refractions (default 8)")
      ->transform(count_between(0, 64))
      ->group(raytrace);
  command
      .add_option("--diffuse-depth", request.diffuse_depth,
                  "path: maximum diffuse scatterings (default 64, more than most paths last)")
      ->transform(count_between(0, 1024))
      ->group(raytrace);
  command
      .add_option("--reach", request.reach,
                  "ao: what is further away hides nothing (default: everything hides)")
      ->check(positive_number())
      ->group(raytrace);
  command.add_flag("--no-shadows", request.no_shadows, "direct: nothing hides lights")
      ->group(raytrace);
  command
      .add_option("--build", request.build,
                  "Embree's structures: low (quick to build), medium (default) or high (quick to "
                  "trace, splits triangles)")
      ->check(one_of({"low", "medium", "high"}))
      ->group(raytrace);
  command
      .add_option("--isa", request.isa,
                  "instructions for Embree: best (default); avx2 may be quicker than avx512 where "
                  "rays go everywhere")
      ->check(one_of({"best", "sse2", "sse4.2", "avx", "avx2", "avx512"}))
      ->group(raytrace);
  command
      .add_option("--schedule", request.schedule,
                  "how ranks share blocks of the picture; sort-first: blocks that change rank "
                  "meanwhile")
      ->group(raytrace);
  command
      .add_option("--master", request.master,
                  "ranks that hand out blocks (demand, guided, hierarchical): works (on some "
                  "itself, default) or serves (the others only)")
      ->check(one_of({"works", "serves"}))
      ->group(raytrace);
  command
      .add_option("--data", request.data,
                  "how ranks share the scene: replicated (default), object, ray, ring or hybrid")
      ->group(raytrace);
  command
      .add_option("--deal", request.deal,
                  "clusters of a shared scene: neighbours to one rank (default), or at random")
      ->check(one_of({"neighbours", "random"}))
      ->group(raytrace);
  command
      .add_option("--cache", request.cache_mebibytes,
                  "MiB of other ranks' clusters that a rank keeps (default a tenth of the scene)")
      ->check(number_between(1e-3, 1e9))
      ->group(raytrace);
  add_practice_options(command, request.practice);
  command.add_option("--stats", request.statistics, "write statistics as JSON; - for stdout");
  command.add_flag("--list", request.list,
                   "list strategies, partitions, schemes, integrators, schedules");
  add_choices(command);
}

void check(const CLI::App& command, RenderRequest& request) {
  if (request.scene.file.path.empty()) throw UsageError("render: SCENE is missing");
  if (request.output.empty()) throw UsageError("render: -o IMAGE is missing");
  if (!image::is_picture_suffix(request.output)) {
    std::string legal;
    for (const char* suffix : image::picture_suffixes()) legal += std::string(" ") + suffix;
    throw UsageError(fmt::format("-o: '{}' does not end in one of{}", request.output, legal));
  }
  parse_size(request);
  request.behind = parse_background(request.background);
  if (request.behind.kind == Background::Kind::transparent && is_jpeg(request.output)) {
    throw UsageError(
        "--background transparent: JPEG has no transparency; .png, .tif and .exr have");
  }
  request.kind = request.engine == "raster" ? Engine::raster : Engine::raytrace;
  if (request.turntable == 0 && request.camera_path.empty())
    refuse(command, {"--frames-at-once"}, "a single picture");
  if (request.kind == Engine::raster) {
    check_raster(command, request);
  } else {
    check_raytrace(command, request);
  }
}

}  // namespace delray::apps
