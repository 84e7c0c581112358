#include "apps/render/practice_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>

#include "apps/options/help.h"
#include "apps/options/list.h"
#include "apps/options/numbers.h"
#include "apps/render/render_options.h"
#include "apps/render/shown_channel.h"
#include "image/tone.h"

namespace delray::apps {
namespace {

constexpr const char* kOptions[] = {
    "--time",     "--noise", "--preview-every", "--checkpoint", "--checkpoint-every",
    "--resume",   "--crop",  "--aovs",          "--denoise",    "--show",
    "--exposure", "--tone",  "--aperture",      "--focus",      "--seed"};

// Samples per pixel without --spp: where time ends the rendering, and where noise does. The noise
// of 256 samples is a sixteenth of that of one; a tenth of it would take 25 600.
constexpr int kMostInTime = 65536, kMostForNoise = 256;

geometry::Rect parse_crop(const std::string& text, int width, int height) {
  std::array<int, 4> n{};
  const char* at = text.data();
  const char* const end = at + text.size();
  bool fine = true;
  for (std::size_t i = 0; i < n.size() && fine; ++i) {
    const auto [next, error] = std::from_chars(at, end, n[i]);
    fine = error == std::errc() && (i == 3 ? next == end : next != end && *next == ',');
    at = next + 1;
  }
  fine = fine && n[0] >= 0 && n[1] >= 0 && n[2] >= 1 && n[3] >= 1 && n[2] <= width - n[0] &&
         n[3] <= height - n[1];
  if (fine) return {n[0], n[1], n[0] + n[2], n[1] + n[3]};
  throw UsageError(
      fmt::format("--crop: '{}' is not x,y,width,height within the picture of {} x {} pixels", text,
                  width, height));
}

void refuse(const CLI::App& command, const char* option, const char* with) {
  if (command.count(option) > 0) {
    throw UsageError(fmt::format("{} has no effect with {}", option, with));
  }
}

}  // namespace

void add_practice_options(CLI::App& command, Practice& practice) {
  command
      .add_option("--time", practice.seconds,
                  "Seconds to sample for, however noisy the picture is then (default: no limit)")
      ->group(group::kRaytracer)
      ->check(positive_number());
  command
      .add_option(
          "--noise", practice.noise,
          "Stop below this noise: the standard deviation of values on the screen, which are 0 to "
          "1, such as 0.01; --spp is the maximum then (default: 256, or none with --time)")
      ->group(group::kRaytracer)
      ->check(positive_float());
  command
      .add_option("--preview-every", practice.preview_every,
                  "Seconds between previews: the picture so far, written to the output file "
                  "(default: none)")
      ->group(group::kRaytracer)
      ->check(positive_number());
  command
      .add_option(
          "--checkpoint", practice.checkpoint,
          "File that keeps all samples so far, now and then and when interrupted, for --resume")
      ->type_name("FILE")
      ->group(group::kRaytracer);
  command
      .add_option("--checkpoint-every", practice.checkpoint_every,
                  "Seconds between checkpoints (default: 60)")
      ->group(group::kRaytracer)
      ->check(non_negative_number());
  command
      .add_flag(
          "--resume", practice.resume,
          "Continue from the file of --checkpoint, to the same picture as without interruption")
      ->group(group::kRaytracer);
  command
      .add_option("--crop", practice.crop,
                  "Render only a part of the picture: x,y,width,height in pixels, from its upper "
                  "left corner")
      ->type_name("RECT")
      ->group(group::kRaytracer);
  command
      .add_flag(
          "--aovs", practice.channels,
          "Also write channels of normals, albedo, ids, variance, samples and costs (.exr only)")
      ->group(group::kRaytracer);
  command
      .add_flag("--denoise", practice.denoise,
                "Remove noise, guided by normals, albedo, depth and variance")
      ->group(group::kRaytracer);
  command
      .add_option("--show", practice.show,
                  fmt::format("Show this instead of colour: {}", fmt::join(shown_names(), ", ")))
      ->group(group::kRaytracer);
  command
      .add_option("--exposure", practice.exposure,
                  "Exposure in stops: light is multiplied by 2 to the power of this (default: 0; "
                  "not for .exr)")
      ->group(group::kRaytracer)
      ->check(number_between(-30.0, 30.0));
  command
      .add_option("--tone", practice.tone,
                  "Tone curve from light to the screen: linear (default) or filmic (not for .exr)")
      ->group(group::kRaytracer);
  command
      .add_option(
          "--aperture", practice.aperture,
          "Diameter of the lens in units of the scene, for depth of field (default: 0, all sharp)")
      ->group(group::kRaytracer)
      ->check(non_negative_number());
  command
      .add_option("--focus", practice.focus,
                  "Distance of what is sharp, along the view, in units of the scene (default: that "
                  "of the point looked at)")
      ->group(group::kRaytracer)
      ->check(positive_float());
  command.add_option("--seed", practice.seed, "Seed of all random numbers (default: 0)")
      ->group(group::kRaytracer)
      ->transform(any_count());
  choose_from(command, "--tone", names_in(image::tone_curves()));
  choose_from(command, "--show", shown_names());
}

void refuse_practice(const CLI::App& command) {
  for (const char* option : kOptions) refuse(command, option, "--engine raster");
}

void check_practice(const CLI::App& command, RenderRequest& request) {
  Practice& practice = request.practice;
  practice.window = {0, 0, request.width, request.height};
  if (!practice.crop.empty()) {
    practice.window = parse_crop(practice.crop, request.width, request.height);
  }
  if (command.count("--spp") == 0) {
    if (practice.noise > 0.0) request.samples = kMostForNoise;
    if (practice.seconds > 0.0) request.samples = kMostInTime;
  }
  if (practice.checkpoint.empty()) {
    refuse(command, "--checkpoint-every", "no --checkpoint");
    if (practice.resume)
      throw UsageError("--resume: from which file? --checkpoint FILE is missing");
  }
  if (practice.aperture == 0.0) refuse(command, "--focus", "no --aperture");
  if (request.is_animation() || request.frames > 1) {
    for (const char* option : {"--preview-every", "--checkpoint", "--aovs"}) {
      refuse(command, option, "more than one frame");
    }
  }
  if (image::picture_suffix(request.output) == ".exr") {
    if (practice.show == "colour") {
      refuse(command, "--exposure", "EXR, which keeps the light itself");
      refuse(command, "--tone", "EXR, which keeps the light itself");
    }
  } else {
    refuse(command, "--aovs", "files other than .exr");
  }
  if (practice.show != "colour") {
    for (const char* option : {"--exposure", "--tone", "--denoise"}) {
      refuse(command, option, "--show");
    }
  }
}

}  // namespace delray::apps
