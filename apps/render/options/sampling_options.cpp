// Options of the ray tracer's sampling and of its result, as rows of `delray render`'s options.
#include "apps/render/options/sampling_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <charconv>

#include "apps/options/help.h"
#include "apps/options/numbers.h"
#include "apps/render/options/option_table.h"
#include "apps/render/shown_channel.h"
#include "image/io.h"
#include "image/tone.h"

namespace delray::apps {
namespace {

// Samples per pixel without --spp: where time ends the rendering, and where noise does. The noise
// of 256 samples is a sixteenth of that of one; a tenth of it would take 25 600.
constexpr int kMostInTime = 65536, kMostForNoise = 256;

bool writes_exr(const RenderRequest& r) { return image::picture_suffix(r.output) == ".exr"; }
bool shows_colour(const RenderRequest& r) { return r.sampling.show == "colour"; }

std::string why_no_frame_alone(const RenderRequest& r) {
  return r.is_animation() || r.frames > 1 ? "more than one frame" : "";
}
std::string why_no_preview(const RenderRequest& r) {
  return r.output == "-" ? "-o -, which takes one picture" : why_no_frame_alone(r);
}
std::string why_no_checkpoint_every(const RenderRequest& r) {
  return r.sampling.checkpoint.empty() ? "no --checkpoint" : "";
}
std::string why_no_channels(const RenderRequest& r) {
  return writes_exr(r) ? why_no_frame_alone(r) : "files other than .exr";
}
std::string why_no_colour(const RenderRequest& r) { return shows_colour(r) ? "" : "--show"; }
std::string why_no_tone(const RenderRequest& r) {
  return shows_colour(r) && writes_exr(r) ? "EXR, which keeps the light itself" : why_no_colour(r);
}
// Samples of other frames are of pixels' centres, and of what stands still.
std::string why_no_reuse(const RenderRequest& r) {
  const SamplingOptions& s = r.sampling;
  if (!r.is_animation()) return "a single picture";
  if (r.motion.is_animation()) return "--animate, whose scene moves";
  if (r.raytrace.samples > 1) return "more than one sample per pixel";
  if (s.denoise) return "--denoise";
  if (!shows_colour(r)) return "--show";
  if (s.aperture > 0) return "--aperture";
  if (r.layout.wall) return "--wall";
  return r.layout.crop.empty() ? "" : "--crop";
}
std::string why_no_focus(const RenderRequest& r) {
  return r.sampling.aperture == 0.0 ? "no --aperture" : "";
}

// A row of this table: all are the ray tracer's.
template <class Field>
RenderOption sampling_option(const char* name, Field field, std::string help, std::string key,
                             std::string (*why)(const RenderRequest&) = nullptr) {
  return RenderOption::of(name, field, group::kRaytracer, std::move(help))
      .unless([why](const RenderRequest& r) -> std::string {
        if (!is_raytrace(r)) return "--engine raster";
        return why != nullptr ? why(r) : "";
      })
      .reported(std::move(key), is_raytrace);
}

}  // namespace

std::vector<RenderOption> sampling_options() {
  return {
      sampling_option(
          "--time", [](auto& r) -> auto& { return r.sampling.seconds; },
          "Seconds to sample for, however noisy the picture is then (default: no limit)", "time")
          .check(positive_number()),
      sampling_option(
          "--noise", [](auto& r) -> auto& { return r.sampling.noise; },
          "Stop below this noise: the standard deviation of values on the screen, which are 0 to "
          "1, such as 0.01; --spp is the maximum then (default: 256, or none with --time)",
          "noise")
          .check(positive_float())
          .in_checkpoint([](const RenderRequest& r) {
            return r.sampling.noise > 0.0 ? fmt::format("{}", r.sampling.noise) : "not given";
          }),
      sampling_option(
          "--preview-every", [](auto& r) -> auto& { return r.sampling.preview_every; },
          "Seconds between previews: the picture so far, written to the output file (default: "
          "none)",
          "preview_every", why_no_preview)
          .check(positive_number()),
      sampling_option(
          "--checkpoint", [](auto& r) -> auto& { return r.sampling.checkpoint; },
          "File that keeps all samples so far, now and then and when interrupted, for --resume",
          "checkpoint", why_no_frame_alone)
          .type_name("FILE"),
      sampling_option(
          "--checkpoint-every", [](auto& r) -> auto& { return r.sampling.checkpoint_every; },
          "Seconds between checkpoints (default: 60)", "checkpoint_every", why_no_checkpoint_every)
          .check(non_negative_number()),
      sampling_option(
          "--resume", [](auto& r) -> auto& { return r.sampling.resume; },
          "Continue from the file of --checkpoint, to the same picture as without interruption",
          "resume"),
      sampling_option(
          "--aovs", [](auto& r) -> auto& { return r.sampling.channels; },
          "Also write channels of normals, albedo, ids, variance, samples and costs (.exr only)",
          "aovs", why_no_channels),
      sampling_option(
          "--denoise", [](auto& r) -> auto& { return r.sampling.denoise; },
          "Remove noise, guided by normals, albedo, depth and variance", "denoise", why_no_colour),
      sampling_option(
          "--show", [](auto& r) -> auto& { return r.sampling.show; },
          fmt::format("Show this instead of colour: {}", fmt::join(shown_names(), ", ")), "show")
          .one_of(shown_names()),
      sampling_option(
          "--exposure", [](auto& r) -> auto& { return r.sampling.exposure; },
          "Exposure in stops: light is multiplied by 2 to the power of this (default: 0; not for "
          ".exr)",
          "exposure", why_no_tone)
          .check(number_between(-30.0, 30.0)),
      sampling_option(
          "--tone", [](auto& r) -> auto& { return r.sampling.tone; },
          "Tone curve from light to the screen: linear (default) or filmic (not for .exr)", "tone",
          why_no_tone)
          .one_of(names_in(image::tone_curves())),
      sampling_option(
          "--aperture", [](auto& r) -> auto& { return r.sampling.aperture; },
          "Diameter of the lens in units of the scene, for depth of field (default: 0, all sharp)",
          "aperture")
          .check(non_negative_number())
          .in_checkpoint([](const RenderRequest& r) {
            return fmt::format("{}", static_cast<float>(r.sampling.aperture));
          }),
      sampling_option(
          "--focus", [](auto& r) -> auto& { return r.sampling.focus; },
          "Distance of what is sharp, along the view, in units of the scene (default: that of the "
          "point looked at)",
          "focus", why_no_focus)
          .check(positive_float())
          .in_checkpoint([](const RenderRequest& r) {
            return fmt::format("{}", static_cast<float>(r.sampling.focus));
          }),
      sampling_option(
          "--reuse", [](auto& r) -> auto& { return r.sampling.reuse; },
          "Of animations with --turntable and --camera-path: trace at most this part of the "
          "pixels, "
          "such as 0.25, and take the others from the frames before, which is an approximation "
          "(default: trace all)",
          "reuse", why_no_reuse)
          .check(number_between(0.01, 1.0)),
      sampling_option(
          "--seed", [](auto& r) -> auto& { return r.raytrace.trace.seed; },
          "Seed of all random numbers (default: 0)", "seed")
          .transform(any_count())
          .in_checkpoint(),
  };
}

void complete_sampling(const CLI::App& command, RenderRequest& request) {
  SamplingOptions& sampling = request.sampling;
  if (command.count("--spp") > 0) return;
  if (sampling.noise > 0.0) request.raytrace.samples = kMostForNoise;
  if (sampling.seconds > 0.0) request.raytrace.samples = kMostInTime;
}

void check_sampling(const RenderRequest& request) {
  if (request.sampling.resume && request.sampling.checkpoint.empty())
    throw UsageError("--resume: from which file? --checkpoint FILE is missing");
}

}  // namespace delray::apps
