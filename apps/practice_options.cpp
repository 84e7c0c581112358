#include "apps/practice_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>

#include "apps/list.h"
#include "apps/numbers.h"
#include "apps/render_options.h"
#include "apps/shown_channel.h"
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

bool is_exr(const std::string& path) { return path.ends_with(".exr") || path.ends_with(".EXR"); }

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
  const std::string group = "Ray tracer";
  command
      .add_option("--time", practice.seconds,
                  "seconds that sampling may take; then the picture is done, however noisy")
      ->check(positive_number())
      ->group(group);
  command
      .add_option("--noise", practice.noise,
                  "Stop sampling where the standard deviation of values on the screen (0 to 1) is "
                  "below this, such as 0.01; --spp is the maximum then (default 256, or none with "
                  "--time)")
      ->check(positive_number())
      ->group(group);
  command
      .add_option("--preview-every", practice.preview_every,
                  "seconds: write the picture so far to the output file so often")
      ->check(positive_number())
      ->group(group);
  command
      .add_option("--checkpoint", practice.checkpoint,
                  "keep all samples so far in this file, now and then and when interrupted")
      ->group(group);
  command
      .add_option("--checkpoint-every", practice.checkpoint_every,
                  "seconds from one checkpoint to the next (default 60)")
      ->check(non_negative_number())
      ->group(group);
  command
      .add_flag("--resume", practice.resume,
                "go on from the file of --checkpoint, to the same picture as without interruption")
      ->group(group);
  command
      .add_option("--crop", practice.crop,
                  "x,y,width,height in pixels: only this part of the picture")
      ->group(group);
  command
      .add_flag("--aovs", practice.channels,
                "EXR: with channels for normal, albedo, ids, variance, samples and costs")
      ->group(group);
  command
      .add_flag("--denoise", practice.denoise,
                "smooth noise, led by normals, albedo, depth and variance")
      ->group(group);
  command
      .add_option("--show", practice.show,
                  fmt::format("what the picture shows: {}", fmt::join(shown_names(), ", ")))
      ->group(group);
  command
      .add_option("--exposure", practice.exposure,
                  "stops: light is multiplied by 2 to the power of this; not in EXR")
      ->check(number_between(-30.0, 30.0))
      ->group(group);
  command
      .add_option("--tone", practice.tone, "from light to the screen: linear (default) or filmic")
      ->group(group);
  command
      .add_option("--aperture", practice.aperture,
                  "diameter of the lens, in units of the scene (default 0: all is sharp)")
      ->check(non_negative_number())
      ->group(group);
  command
      .add_option("--focus", practice.focus,
                  "distance of what is sharp, along the view (default: that of what is looked at)")
      ->check(positive_number())
      ->group(group);
  command.add_option("--seed", practice.seed, "of all random numbers (default 0)")
      ->transform(any_count())
      ->group(group);
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
  const bool animated = request.turntable > 0 || !request.camera_path.empty();
  if (animated || request.frames > 1) {
    for (const char* option : {"--preview-every", "--checkpoint", "--aovs"}) {
      refuse(command, option, "more than one frame");
    }
  }
  if (is_exr(request.output)) {
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
