#include "apps/render/render_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <charconv>
#include <initializer_list>

#include "apps/options/help.h"
#include "apps/options/list.h"
#include "apps/options/numbers.h"
#include "apps/options/scheme_option.h"
#include "apps/render/video.h"
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

bool is_jpeg(const std::string& path) {
  const std::string suffix = image::picture_suffix(path);
  return suffix == ".jpg" || suffix == ".jpeg";
}

// That the output is a picture, or of an animation a video.
void check_output(const CLI::App& command, RenderRequest& request) {
  request.frames_output = request.output;
  if (is_video(request.output)) {
    if (request.is_animation()) return;
    throw UsageError(
        fmt::format("-o: '{}' is a video, for --turntable or --camera-path", request.output));
  }
  if (!image::is_picture_suffix(request.output)) {
    std::string legal;
    for (const char* suffix : image::picture_suffixes()) legal += std::string(" ") + suffix;
    if (request.is_animation()) legal += " .mp4";
    throw UsageError(fmt::format("-o: '{}' does not end in one of{}", request.output, legal));
  }
  if (request.output != "-") return;
  if (request.is_animation()) {
    throw UsageError("-o -: standard output takes one picture, an animation is many");
  }
  refuse(command, {"--preview-every"}, "-o -, which takes one picture");
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
  if (!raytrace::integrator(request.integrator).lit)
    refuse(command, {"--light"}, "--integrator " + request.integrator + ", which shows no light");
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
  command
      .add_option("-o,--output", request.output,
                  "Picture to write: .png, .exr, .tif or .jpg; - for PNG on standard output; of an "
                  "animation .mp4 too, where ffmpeg is installed")
      ->type_name("FILE")
      ->group(group::kOutput);
  command
      .add_option("--size", request.size,
                  "Width and height in pixels, such as 1920x1080 (default: 1280x720)")
      ->type_name("WxH")
      ->group(group::kPicture);
  command
      .add_option("--engine", request.engine,
                  "Renderer: raster, the rasterizer (default), or raytrace, the ray tracer")
      ->group(group::kPicture)
      ->check(one_of({"raster", "raytrace"}));
  command
      .add_option("--frames", request.frames,
                  "Render the picture this many times and report the median time (default: 1)")
      ->group(group::kOutput)
      ->transform(count_between(1, 100000));
  command
      .add_option("--background", request.background,
                  "What is behind the scene: environment, studio (grey, brighter above), "
                  "transparent, a colour as #rrggbb, or auto (default), which suits the scene")
      ->type_name("WHAT")
      ->group(group::kPicture);
  add_light_options(command, request.light);
  add_camera_options(command, request.camera);
  command
      .add_option("--turntable", request.turntable,
                  "Animation of so many frames once around the scene: IMAGE-0000 and on")
      ->group(group::kCamera)
      ->transform(count_between(1, 1000000))
      ->excludes("--frames");
  command
      .add_option("--camera-path", request.camera_path,
                  "Animation along the cameras in this file, one a line: [FRAME:] eye,at,up,fov")
      ->type_name("FILE")
      ->group(group::kCamera)
      ->excludes("--frames")
      ->excludes("--turntable")
      ->excludes("--camera")
      ->excludes("--view");
  command
      .add_option(
          "--frames-at-once", request.frames_at_once,
          "Frames of an animation to work on at the same time (default: threads + 2, but 4 to 8)")
      ->group(group::kCamera)
      ->transform(count_between(1, 64));
  add_launch_options(command, request.launch);
  command
      .add_option("--strategy", request.strategy,
                  "Rasterizer: whether primitives, triangles or pixels go to other ranks: "
                  "sort-first, sort-middle, sort-last (default) or hybrid")
      ->group(group::kSharing);
  command
      .add_option("--partition", request.partition,
                  "How the screen is divided among ranks, for all strategies but sort-last "
                  "(default: mahd); ray tracer: the blocks that ranks begin with, for the "
                  "schedules static and stealing (default: none)")
      ->group(group::kSharing);
  command
      .add_option("--compose", request.scheme,
                  "Compositing scheme, which merges the images of all ranks, for --strategy "
                  "sort-last (default: binary-swap)")
      ->group(group::kSharing);
  command
      .add_option("--shading", request.lighting,
                  "Lighting of surfaces: phong, at every pixel (default), or gouraud, at vertices")
      ->group(group::kRasterizer)
      ->check(one_of({"phong", "gouraud"}));
  command
      .add_option("--codec", request.codec,
                  "Pixel encoding between ranks, for --strategy sort-last (default: dense)")
      ->group(group::kSharing);
  command
      .add_option("--blend", request.blend,
                  "Transparent surfaces, for --strategy sort-last: by-owner, the rank that owns a "
                  "pixel sorts all its fragments (default, exact), or by-cell, each rank blends "
                  "those in its cell of space, and cells are merged front to back")
      ->group(group::kSharing)
      ->check(one_of({"by-owner", "by-cell"}));
  command
      .add_option(
          "--shade", request.shade,
          "When pixels are shaded: immediate, as they are drawn; deferred, once all is drawn "
          "(default); composited, once the images of all ranks are merged (sort-last)")
      ->group(group::kRasterizer)
      ->check(one_of({"deferred", "immediate", "composited"}));
  command
      .add_option("--samples", request.supersampling,
                  "Samples per pixel in each direction: 1 (default), 2 or 4, which is 16 per pixel")
      ->group(group::kRasterizer)
      ->check(one_of({"1", "2", "4"}));
  command
      .add_option("--travel", request.travel,
                  "How primitives are sent to other ranks, for --strategy sort-first and hybrid: "
                  "as geometry (default), or as numbers, by which they are looked up in the scene")
      ->group(group::kSharing)
      ->check(one_of({"geometry", "numbers"}));
  command
      .add_option("--costs", request.costs,
                  "Costs that partitions balance: model, an estimate (default), or measured, times "
                  "of the last frame")
      ->group(group::kSharing)
      ->check(one_of({"model", "measured"}));
  command
      .add_option("--regions", request.regions_per_rank,
                  "Regions of the screen per rank (default: 1)")
      ->group(group::kSharing)
      ->transform(count_between(1, 64));
  command
      .add_option("--keep", request.keep_factor,
                  "Repartition when a rank exceeds this multiple of the mean load (default: 1.2)")
      ->group(group::kSharing)
      ->check(number_between(1.0, 1000.0));
  command
      .add_option("--block", request.block,
                  "Side in pixels of the blocks that --schedule hands out (default: 64; ray "
                  "tracer: a multiple of 16, by default 16, or 32 with path)")
      ->group(group::kSharing)
      ->transform(count_between(1, 4096));
  command
      .add_option("--groups", request.groups,
                  "For --strategy sort-middle: one group of ranks, each for geometry and pixels "
                  "(default), or two groups, one for geometry and one for pixels")
      ->group(group::kSharing)
      ->check(one_of({"one", "two"}));
  command
      .add_option("--geometry-ranks", request.geometry_ranks,
                  "Number of ranks for geometry, for --groups two (default: half of all)")
      ->group(group::kSharing)
      ->transform(count_between(1, 1000000));
  command
      .add_option("--redistribute", request.redistribution,
                  "For --strategy sort-middle: send triangles in batches as they are transformed "
                  "(immediate, default), or all at-end")
      ->group(group::kSharing)
      ->check(one_of({"immediate", "at-end"}));
  command
      .add_option("--integrator", request.integrator,
                  "What is computed along rays (default: whitted; --list describes them)")
      ->group(group::kRaytracer);
  command.add_option("--spp", request.samples, "Samples per pixel (default: 1)")
      ->group(group::kRaytracer)
      ->transform(count_between(1, 65536));
  command.add_option("--depth", request.depth, "Maximum reflections and refractions (default: 8)")
      ->group(group::kRaytracer)
      ->transform(count_between(0, 64));
  command
      .add_option(
          "--diffuse-depth", request.diffuse_depth,
          "Maximum diffuse bounces, for --integrator path (default: 64, more than most paths last)")
      ->group(group::kRaytracer)
      ->transform(count_between(0, 1024));
  command
      .add_option("--reach", request.reach,
                  "Ambient occlusion radius in units of the scene, for --integrator ao (default: "
                  "unlimited)")
      ->group(group::kRaytracer)
      ->check(positive_float());
  command
      .add_flag("--no-shadows", request.no_shadows,
                "Trace no shadow rays, for --integrator direct: light passes through everything")
      ->group(group::kRaytracer);
  command
      .add_option("--build", request.build,
                  "Quality of Embree's bounding volume hierarchies: low (fast to build), medium "
                  "(default) or high (fast to trace, splits triangles)")
      ->group(group::kRaytracer)
      ->check(one_of({"low", "medium", "high"}));
  command
      .add_option("--isa", request.isa,
                  "Instruction set for Embree: sse2, sse4.2, avx, avx2, avx512 or best, of this "
                  "processor (default); avx2 may be faster than avx512 for incoherent rays")
      ->group(group::kRaytracer)
      ->check(one_of({"best", "sse2", "sse4.2", "avx", "avx2", "avx512"}));
  command
      .add_option("--schedule", request.schedule,
                  "How ranks share the blocks of the picture (ray tracer, default: interlaced); "
                  "rasterizer: the same for --strategy sort-first (default: none, each rank keeps "
                  "its regions)")
      ->group(group::kSharing);
  command
      .add_option("--master", request.master,
                  "Whether ranks that hand out blocks (schedules demand, guided and hierarchical) "
                  "render some too: works, they do (default), or serves, they do not")
      ->group(group::kSharing)
      ->check(one_of({"works", "serves"}));
  command
      .add_option("--data", request.data,
                  "Ray tracer: distribution of the scene: replicated, all of it on every rank "
                  "(default), object, ray, ring or hybrid")
      ->group(group::kSharing);
  command
      .add_option("--deal", request.deal,
                  "Which rank gets which parts of a scene that --data distributes: neighbours stay "
                  "together (default), or random")
      ->group(group::kSharing)
      ->check(one_of({"neighbours", "random"}));
  command
      .add_option("--cache", request.cache_mebibytes,
                  "MiB of other ranks' parts of the scene that a rank keeps, for --data object and "
                  "hybrid (default: a tenth of the scene)")
      ->group(group::kSharing)
      ->check(number_between(1e-3, 1e9));
  add_practice_options(command, request.practice);
  command
      .add_option("--stats", request.statistics,
                  "Statistics as JSON to this file; - for standard output")
      ->type_name("FILE")
      ->group(group::kOutput);
  command
      .add_flag("--list", request.list,
                "List the names that options choose from, and what they mean")
      ->group(group::kOutput);
  add_choices(command);
}

void check(const CLI::App& command, RenderRequest& request) {
  if (request.scene.file.path.empty()) throw UsageError("render: SCENE is missing");
  if (request.output.empty()) throw UsageError("render: -o IMAGE is missing");
  check_output(command, request);
  parse_size(request);
  check_light(command, request.light);
  request.behind = parse_background(request.background);
  const bool is_opaque = is_jpeg(request.output) || is_video(request.output);
  if (request.behind.kind == Background::Kind::transparent && is_opaque) {
    throw UsageError(
        fmt::format("--background transparent: {} has no transparency; .png, .tif and .exr have",
                    is_video(request.output) ? "a video" : "JPEG"));
  }
  request.kind = request.engine == "raster" ? Engine::raster : Engine::raytrace;
  if (!request.is_animation()) refuse(command, {"--frames-at-once"}, "a single picture");
  if (request.kind == Engine::raster) {
    check_raster(command, request);
  } else {
    check_raytrace(command, request);
  }
}

}  // namespace delray::apps
