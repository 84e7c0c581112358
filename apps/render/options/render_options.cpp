// Completes the options of `delray render`, and checks what goes together.
#include "apps/render/options/render_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <charconv>

#include "apps/options/help.h"
#include "apps/options/list.h"
#include "apps/options/scheme_option.h"
#include "apps/render/options/option_table.h"
#include "apps/render/options/sampling_options.h"
#include "apps/render/video.h"
#include "image/io.h"
#include "raster/strategies.h"
#include "raytrace/integrator.h"

namespace delray::apps {
namespace {

bool is_jpeg(const std::string& path) {
  const std::string suffix = image::picture_suffix(path);
  return suffix == ".jpg" || suffix == ".jpeg";
}

// That the output is a picture, or of an animation a video.
void check_output(RenderRequest& request) {
  request.frames_output = request.output;
  if (is_video(request.output)) {
    if (request.is_animation()) return;
    throw UsageError(fmt::format("-o: '{}' is a video, for --turntable, --camera-path or --animate",
                                 request.output));
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
}

// All of them, in the order of the help.
const std::vector<RenderOption>& all_options() {
  static const std::vector<RenderOption> all = [] {
    std::vector<RenderOption> rows;
    for (auto family : {picture_options, layout_options, animation_options, rasterizer_options,
                        pack_options, raytracer_options, sampling_options, output_options}) {
      for (RenderOption& row : family()) rows.push_back(std::move(row));
    }
    return rows;
  }();
  return all;
}

void refuse_if_idle(const RenderOption& option, const CLI::App& command,
                    const RenderRequest& request) {
  if (command.count(option.flag()) == 0) return;
  const std::string why = option.why_idle(request);
  if (!why.empty()) throw UsageError(fmt::format("{} has no effect with {}", option.flag(), why));
}

// Defaults that depend on the engine, for options that were not given.
void complete(const CLI::App& command, RenderRequest& request) {
  Sharing& sharing = request.sharing;
  if (request.engine == Engine::raster) return;
  if (sharing.schedule.empty()) sharing.schedule = "interlaced";
  if (command.count("--block") == 0)
    sharing.block = raytrace::integrator(request.raytrace.integrator).side;
  if (command.count("--partition") == 0) sharing.partition.clear();
  complete_sampling(command, request);
}

void check_layout(const RenderRequest& request) {
  const FrameLayout& layout = request.layout;
  if (request.legend && layout.wall)
    throw UsageError("--legend is for one picture, not for the displays of --wall");
  if (request.shading == SurfaceLighting::eye_dome && (layout.wall || !layout.crop.empty())) {
    throw UsageError(
        "--shading eye-dome looks at neighbours of every pixel: it is for a whole picture, without "
        "--crop and --wall");
  }
}

void check_raster(const RenderRequest& request) {
  if (request.raster.shade != raster::Shade::composited) return;
  if (!raster::find_strategy(request.raster.strategy)->composites)
    throw UsageError("--shade composited: only --strategy sort-last composites");
  if (request.shading == SurfaceLighting::gouraud)
    throw UsageError("--shade composited: vertices are lit before with --shading gouraud");
}

void check_raytrace(const CLI::App& command, RenderRequest& request) {
  if (!raytrace::integrator(request.raytrace.integrator).lit && command.count("--light") > 0) {
    throw UsageError(fmt::format("--light has no effect with --integrator {}, which shows no light",
                                 request.raytrace.integrator));
  }
  check_sampling(request);
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
  request.window = {0, 0, request.width, request.height};
}

void add_render_options(CLI::App& command, RenderRequest& request) {
  add_scene_options(command, request.scene);
  for (auto family : {picture_options, layout_options}) {
    for (const RenderOption& option : family()) option.add(command, request);
  }
  add_light_options(command, request.light);
  add_camera_options(command, request.camera);
  for (const RenderOption& option : animation_options()) option.add(command, request);
  add_launch_options(command, request.launch);
  for (auto family :
       {rasterizer_options, pack_options, raytracer_options, sampling_options, output_options}) {
    for (const RenderOption& option : family()) option.add(command, request);
  }
  choose_scheme(command);
}

void refuse_if_idle(std::string_view name, const CLI::App& command, const RenderRequest& request) {
  refuse_if_idle(*std::ranges::find(all_options(), name, &RenderOption::flag), command, request);
}

void add_options(std::initializer_list<std::string_view> names, CLI::App& command,
                 RenderRequest& request) {
  for (const std::string_view name : names) {
    const auto option = std::ranges::find(all_options(), name, &RenderOption::flag);
    option->add(command, request);
  }
}

std::map<std::string, OptionState> option_states(const CLI::App& command, RenderRequest request) {
  complete(command, request);
  std::map<std::string, OptionState> states;
  for (const RenderOption& option : all_options())
    states[option.flag()] = {option.value(request), option.why_idle(request)};
  return states;
}

Json chosen_options(const RenderRequest& request) {
  Json chosen;
  for (const RenderOption& option : all_options()) {
    if (option.is_reported(request)) chosen[option.key()] = option.value(request);
  }
  return chosen;
}

std::vector<raytrace::NamedValue> checkpoint_options(const RenderRequest& request) {
  std::vector<raytrace::NamedValue> values;
  for (const RenderOption& option : all_options()) {
    if (option.is_in_checkpoint()) {
      values.push_back({option.flag(), option.checkpoint_text(request)});
    }
  }
  return values;
}

void check(const CLI::App& command, RenderRequest& request) {
  if (request.scene.file.path.empty()) throw UsageError("render: SCENE is missing");
  if (request.output.empty()) throw UsageError("render: -o IMAGE is missing");
  check_output(request);
  parse_size(request);
  complete_layout(request);
  check_light(command, request.light);
  check(request.motion);
  request.behind = parse_background(request.background);
  const bool is_opaque = is_jpeg(request.output) || is_video(request.output);
  if (request.behind.kind == Background::Kind::transparent && is_opaque) {
    throw UsageError(
        fmt::format("--background transparent: {} has no transparency; .png, .tif and .exr have",
                    is_video(request.output) ? "a video" : "JPEG"));
  }
  complete(command, request);
  for (const RenderOption& option : all_options()) refuse_if_idle(option, command, request);
  check_layout(request);
  if (request.engine == Engine::raster) {
    check_raster(request);
  } else {
    check_raytrace(command, request);
  }
}

}  // namespace delray::apps
