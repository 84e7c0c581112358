// Translates sampling options into a progressive rendering, and its result into picture, channels
// and statistics.
//
// A checkpoint carries a fingerprint of the scene and of every option that samples depend on; one
// of other settings is refused. Checkpoints and previews are made between passes, when their time
// has come.
#include "apps/render/ray_frame.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <optional>

#include "apps/render/shown_channel.h"
#include "comm/agree_on_failure.h"
#include "raytrace/checkpoint.h"
#include "raytrace/denoise.h"

namespace delray::apps {
namespace {

using Clock = std::chrono::steady_clock;

// Says so once every so many seconds, never if that is 0.
class Every {
 public:
  explicit Every(double seconds) : seconds_(seconds) {}
  bool due() {
    const auto now = Clock::now();
    if (seconds_ < 0.0 || std::chrono::duration<double>(now - last_).count() < seconds_) {
      return false;
    }
    last_ = now;
    return true;
  }

 private:
  double seconds_;
  Clock::time_point last_ = Clock::now();
};

std::string text_of(const glm::vec3& v) { return fmt::format("{},{},{}", v.x, v.y, v.z); }

// All that samples depend on, exactly; the same whether ranks have the whole scene or parts of it.
raytrace::Rendering rendering_of(const RenderRequest& request, const scenes::Camera& camera,
                                 const Prepared& prepared) {
  const SamplingOptions& p = request.sampling;
  const geometry::Rect all{0, 0, request.width, request.height};
  const bool scattered = p.noise > 0.0 || p.seconds > 0.0;
  const bool any_samples = raytrace::integrator(request.raytrace.integrator).any_samples;
  const auto text = [](const auto& value) { return fmt::format("{}", value); };
  raytrace::Rendering rendering;
  rendering.scene = prepared.fingerprint;
  rendering.values = checkpoint_options(request);
  rendering.values.push_back({"triangles", text(prepared.triangles)});
  rendering.values.push_back(
      {"--camera", fmt::format("{},{},{},{}", text_of(camera.eye), text_of(camera.at),
                               text_of(camera.up), camera.vertical_fov)});
  rendering.values.push_back({"near plane of the camera", text(camera.near)});
  rendering.values.push_back({"height of the view", text(camera.height)});
  if (!any_samples)
    rendering.values.push_back({"--noise or --time", scattered ? "given" : "not given"});
  rendering.window = raytrace::grown(request.window, all);
  rendering.samples = request.raytrace.samples;
  rendering.any_samples = any_samples || scattered;
  return rendering;
}

// Empty where samples are too few to tell.
std::vector<float> variance_of(const raytrace::Film& film, const geometry::Rect& window) {
  for (const std::uint32_t samples : film.samples()) {
    if (raytrace::chunks(static_cast<int>(samples)) < 2) return {};
  }
  const std::vector<float> all = raytrace::variance(film);
  std::vector<float> result;
  for (int y = window.y0; y < window.y1; ++y) {
    const auto row = all.begin() + static_cast<std::ptrdiff_t>(film.pixel(window.x0, y));
    result.insert(result.end(), row, row + window.width());
  }
  return result;
}

// The part of the film's pixels that are in cells noisier than the threshold.
double noisy_part(const raytrace::Film& film, float threshold) {
  const std::vector<float> noise = raytrace::noise(film);
  std::int64_t noisy = 0;
  for (std::size_t c = 0; c < noise.size(); ++c) {
    if (noise[c] > threshold) noisy += film.cell(c).area();
  }
  return static_cast<double>(noisy) / static_cast<double>(film.window().area());
}

// Facts of the sampling, of at most so many samples per pixel, and channels where they are wanted.
Extras extras_of(const raytrace::ProgressiveResult& result, const RenderRequest& request,
                 int samples) {
  const SamplingOptions& sampling = request.sampling;
  Extras extras;
  extras.passes = result.passes;
  extras.out_of_time = result.out_of_time;
  extras.samples = result.film.pixels().empty()
                       ? static_cast<double>(samples)
                       : static_cast<double>(result.film.total_samples()) /
                             static_cast<double>(result.film.pixels().size());
  if (sampling.noise > 0.0) {
    extras.noisy = noisy_part(result.film, static_cast<float>(sampling.noise));
    if (extras.noisy > 0.0) {
      spdlog::info("{:.3g} % of the picture is noisier than --noise {}: {} ended sampling",
                   100.0 * extras.noisy, sampling.noise,
                   result.out_of_time
                       ? "--time"
                       : fmt::format("a maximum of {} samples per pixel (--spp)", samples));
    }
  }
  if (sampling.channels) extras.channels = channels_of(result, request.window);
  return extras;
}

// Has every pass shown, and the rendering end where nobody wants the next part of one.
void grow(Growth& growth, const RenderRequest& request, raytrace::ProgressiveOptions& options) {
  constexpr double kPart = 0.03;  // seconds: a frame of a picture that moves
  if (!growth.film.pixels().empty()) options.resume = &growth.film;
  options.resume_cells = growth.cells_left;
  options.film = true;
  options.part_seconds = kPart;
  options.goes_on = growth.goes_on;
  options.after_pass = [&growth, window = request.window](const raytrace::Film& film) {
    const auto pixels = static_cast<double>(std::max<std::size_t>(1, film.pixels().size()));
    growth.show(raytrace::cut(raytrace::mean(film), film.window(), window),
                static_cast<double>(film.total_samples()) / pixels);
  };
}

}  // namespace

RayFrame render_rays(comm::Communicator& communicator, raytrace::Renderer& renderer,
                     const Prepared& prepared, const RenderRequest& request,
                     const scenes::Camera& camera, const raytrace::RenderOptions& frame,
                     const Onlookers& onlookers) {
  const Preview& preview = onlookers.preview;
  Growth* const growth = onlookers.growth;
  const SamplingOptions& sampling = request.sampling;
  const bool root = communicator.rank() == 0;
  raytrace::ProgressiveOptions options;
  options.frame = frame;
  options.window = request.window;
  options.noise = static_cast<float>(sampling.noise);
  if (sampling.seconds > 0.0) options.seconds = sampling.seconds;
  options.film = sampling.channels || sampling.denoise || sampling.show != "colour";
  options.features = sampling.channels || sampling.denoise || shows_features(sampling.show);

  raytrace::Rendering rendering;
  std::optional<raytrace::Film> saved;
  if (!sampling.checkpoint.empty()) {
    comm::all_or_none(communicator, comm::Phase::load, [&] {
      if (!root) return;
      rendering = rendering_of(request, camera, prepared);
      if (!sampling.resume) return;
      saved = raytrace::load_checkpoint(sampling.checkpoint, rendering,
                                        request.scene.file.limits.budget());
    });
  }
  if (saved) options.resume = &*saved;
  const auto save = [&](const raytrace::Film& film) {
    raytrace::save_checkpoint(sampling.checkpoint, rendering, film);
  };
  Every preview_due(sampling.preview_every > 0.0 && preview ? sampling.preview_every : -1.0);
  Every checkpoint_due(sampling.checkpoint.empty() ? -1.0 : sampling.checkpoint_every);
  if (growth != nullptr) grow(*growth, request, options);
  if (!sampling.checkpoint.empty() || sampling.preview_every > 0.0) {
    options.after_pass = [&](const raytrace::Film& film) {
      if (checkpoint_due.due()) save(film);
      if (preview_due.due()) {
        preview(raytrace::cut(raytrace::mean(film), film.window(), request.window));
      }
    };
  }
  if (!sampling.checkpoint.empty()) {
    options.on_interruption = [&](const raytrace::Film& film) {
      save(film);
      spdlog::info("{}: {} samples a pixel are kept; go on with --resume", sampling.checkpoint,
                   film.total_samples() / std::max<std::uint64_t>(1, film.pixels().size()));
    };
  }

  raytrace::ProgressiveResult result =
      raytrace::render_progressively(communicator, renderer, camera, options);
  RayFrame done;
  done.statistics = std::move(result.statistics);
  done.shown = std::move(result.shown);
  if (!root) return done;
  if (growth != nullptr) {
    growth->is_done = !result.stopped;
    growth->cells_left = std::move(result.cells_left);
    if (result.stopped) {
      growth->film = std::move(result.film);
      return done;
    }
  }
  if (!sampling.checkpoint.empty()) save(result.film);
  done.extras = extras_of(result, request, frame.samples);
  done.picture = std::move(result.image);
  if (sampling.denoise) {
    raytrace::denoise(done.picture, result.features, variance_of(result.film, request.window));
  }
  if (sampling.show != "colour") {
    const double most = show(sampling.show, result, request.window, done.picture);
    if (most > 0.0) spdlog::info("{}: 99 % are below {:.6g}", sampling.show, most);
  }
  return done;
}

}  // namespace delray::apps
