// delray render: a scene, points or a mesh to a picture.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <filesystem>
#include <optional>

#include "apps/commands.h"
#include "apps/families.h"
#include "apps/interrupt.h"
#include "apps/options/list.h"
#include "apps/options/outputs.h"
#include "apps/render/animation.h"
#include "apps/render/bands.h"
#include "apps/render/displays.h"
#include "apps/render/options/render_options.h"
#include "apps/render/render_frames.h"
#include "apps/render/render_statistics.h"
#include "apps/render/scene_facts.h"
#include "apps/render/video.h"
#include "apps/render/write_picture.h"
#include "apps/terminal/progress_bar.h"
#include "comm/agree_on_failure.h"
#include "comm/handshake.h"
#include "composite/codec.h"
#include "composite/scheme.h"
#include "files/output_path.h"
#include "loadbalance/partition.h"
#include "loadbalance/schedule.h"
#include "parallel/arena.h"
#include "raster/strategies.h"
#include "raytrace/checkpoint.h"
#include "raytrace/distribution.h"
#include "raytrace/integrator.h"

namespace delray::apps {
namespace {

constexpr const char* kFramesPerSecond = "30";  // of videos whose frames have no times

int print_lists() {
  list_colours();
  list_strategies();
  list_partitions();
  list_schemes();
  list_codecs();
  list_integrators();
  list_distributions();
  list_schedules();
  return kDone;
}

// "load 0.1, build 0.2"
std::string listed(const Json& numbers) {
  std::string text;
  for (const auto& [name, value] : numbers.items()) {
    if (value.is_number() && value.get<double>() != 0.0)
      text += fmt::format("{}{} {:.9g}", text.empty() ? "" : ", ", name, value.get<double>());
  }
  return text;
}

// For -v.
void log_details(const Json& statistics) {
  spdlog::debug("scene: {}", listed(statistics["scene"]));
  spdlog::debug("seconds: {}", listed(statistics["seconds"]));
  spdlog::debug("seconds of phases: {}", listed(statistics["phases"]));
  const std::string rays = listed(statistics["rays"]);
  if (!rays.empty()) spdlog::debug("rays: {}", rays);
  for (const Json& rank : statistics["ranks"]) spdlog::debug("rank: {}", listed(rank));
}

// Rank 0: background, file, statistics of a single picture.
void finish(const RenderRequest& request, const Session& session, const Prepared& prepared,
            Frames& frames) {
  Stopwatch watch;
  if (shows_nothing(request, frames.picture)) {
    spdlog::warn("{}: nothing of the scene is in view", request.scene.file.path);
  }
  put_background_behind(request, prepared, prepared.camera, request.window, frames.picture);
  const std::string hash = write_picture(session, request.output, frames.picture, frames.extras);
  const Json statistics = render_statistics(request, prepared, frames, hash, watch.lap());
  write_statistics(request.statistics, statistics);
  spdlog::info("{}: {} x {}, {}, {:.3f} s a frame",
               request.output == "-" ? "standard output" : request.output, request.picture_width(),
               request.picture_height(), primitives_text(prepared.triangles, prepared.points),
               statistics["seconds"]["frame"].get<double>());
  log_details(statistics);
}

// Rank 0: statistics of a picture in several files, or in one that was written in bands.
void finish(const RenderRequest& request, const Prepared& prepared, const Frames& frames,
            const std::string& hash, bool is_empty, double write_seconds, const Json& wall,
            const std::string& files) {
  if (is_empty) spdlog::warn("{}: nothing of the scene is in view", request.scene.file.path);
  Json statistics = render_statistics(request, prepared, frames, hash, write_seconds);
  if (!wall.is_null()) statistics["wall"] = wall;
  write_statistics(request.statistics, statistics);
  spdlog::info("{}: {} x {}, {} triangles, {:.3f} s a frame", files, request.picture_width(),
               request.picture_height(), prepared.triangles,
               statistics["seconds"]["frame"].get<double>());
  log_details(statistics);
}

// Rank 0: statistics of an animation, whose files are there.
void finish(const RenderRequest& request, const Prepared& prepared, const Animation& animation) {
  const std::size_t frames = prepared.cameras.size();
  Json statistics = render_statistics(request, prepared, animation.frames, animation.hash,
                                      animation.all.stages.back());
  statistics["animation"] = animation_statistics(animation);
  write_statistics(request.statistics, statistics);
  const std::string files = is_video(request.output)
                                ? request.output
                                : fmt::format("{} .. {}", frame_path(request.output, 0),
                                              frame_path(request.output, frames - 1));
  spdlog::info("{}: {} frames, {:.3f} s a frame", files, frames,
               animation.all.seconds / static_cast<double>(frames));
  if (animation.empty_frames > 0) {
    spdlog::warn("{}: nothing of the scene is in view in {} of {} frames", request.scene.file.path,
                 animation.empty_frames, frames);
  }
  std::string stages;
  for (std::size_t i = 0; i < animation.stages.size(); ++i) {
    stages += fmt::format("{}{} {:.3f} s", i == 0 ? "" : ", ", animation.stages[i],
                          animation.alone.stages[i]);
  }
  spdlog::info("a frame alone: {}; up to {} at once: {:.2f} times as fast, predicted {:.2f}",
               stages, animation.slots, animation.speed_up(), animation.predicted_speed_up());
}

// Whose names are known before anything is read.
std::vector<std::string> inputs_of(const RenderRequest& request) {
  std::vector<std::string> inputs = request.scene.file.paths;
  inputs.push_back(request.camera_path);
  inputs.push_back(request.light.is_picture() ? request.light.light : "");
  return inputs;
}

// Hours of samples, or another file.
void refuse_to_lose(const SamplingOptions& sampling) {
  std::error_code error;
  const std::string& path = sampling.checkpoint;
  if (sampling.resume || path.empty() || !std::filesystem::is_regular_file(path, error) ||
      std::filesystem::file_size(path, error) == 0) {
    return;
  }
  throw UsageError(
      fmt::format("--checkpoint: '{}' {}", path,
                  raytrace::is_checkpoint(path)
                      ? "holds samples already: go on from them with --resume, or delete it"
                      : "is no checkpoint, and would be overwritten"));
}

// Nobody wants to know of these after an hour.
void prepare_outputs(RenderRequest& request, std::optional<VideoFrames>& video) {
  const std::string output =
      request.layout.has_displays() ? display_path(request.output, 0, 0) : request.output;
  for (const std::string& path : {output, request.statistics, request.sampling.checkpoint}) {
    files::check_writable(path);
  }
  refuse_to_lose(request.sampling);
  if (!is_video(request.output)) return;
  video.emplace(request.output, request.motion.is_animation()
                                    ? parse_animate(request.motion.animate).frames_per_second
                                    : kFramesPerSecond);
  request.frames_output = video->frames();
}

void refuse_overwriting(const RenderRequest& request, const std::vector<std::string>& inputs) {
  std::vector<OutputFile> outputs = {{"--stats", request.statistics},
                                     {"--checkpoint", request.sampling.checkpoint}};
  if (request.layout.has_displays()) {
    for (int i = 0; i < request.layout.wall->displays(); ++i) {
      const int columns = request.layout.wall->columns;
      outputs.push_back({"-o", display_path(request.output, i % columns, i / columns)});
    }
  } else if (!request.is_animation() || is_video(request.output)) {
    outputs.push_back({"-o", request.output});
  } else {
    std::vector<std::string> others = inputs;
    others.push_back(request.statistics);
    for (const std::string& other : others) {
      if (const auto frame = frame_number(other)) {
        outputs.push_back({"-o", frame_path(request.output, *frame)});
      }
    }
  }
  refuse_overwriting(outputs, inputs);
}

int run(Session& session, const CLI::App& command, RenderRequest request) {
  if (request.list) return print_lists();
  check(command, request);
  refuse_overwriting(request, inputs_of(request));
  if (!session.under_mpi) refuse_terminal(request.output);
  check(session, request.launch);
  ProgressBar bar(session, "render");
  std::optional<StopOnTermination> stop;
  if (!request.sampling.checkpoint.empty()) stop.emplace();
  parallel::Progress* const progress = &session.progress;
  std::optional<VideoFrames> video;        // of rank 0
  std::shared_ptr<const Prepared> shared;  // by the ranks of this process
  if (!session.under_mpi) {
    prepare_outputs(request, video);
    const int ranks = std::max(1, request.launch.ranks);
    const int threads = threads_per_rank(request.launch, ranks) * ranks;
    const parallel::AllowThreads allowed(threads);
    parallel::Arena arena(threads);
    shared = arena.execute([&] { return prepare(request, progress); });
    refuse_overwriting(request, shared->scene.files);
  }
  const auto render_in_bands = [&](comm::Communicator& communicator, const Prepared& prepared,
                                   const std::vector<geometry::Rect>& bands) {
    const BandedPicture picture =
        render_bands(communicator, prepared, request, session, progress, bands);
    comm::all_or_none(communicator, comm::Phase::other, [&] {
      if (communicator.rank() != 0) return;
      bar.end();
      finish(request, prepared, picture.frames, picture.hash, picture.is_empty,
             picture.write_seconds, Json(),
             request.layout.one_file
                 ? request.output
                 : fmt::format("{}, in {} bands", request.output, bands.size()));
    });
  };
  const auto write_wall = [&](comm::Communicator& communicator, const Prepared& prepared,
                              Frames& frames) {
    Stopwatch watch;
    const std::vector<ShownDisplay> displays =
        write_displays(communicator, prepared, request, session, std::move(frames.shown));
    comm::all_or_none(communicator, comm::Phase::other, [&] {
      if (communicator.rank() != 0) return;
      bar.end();
      finish(request, prepared, frames, hash_of(displays),
             std::ranges::all_of(displays, &ShownDisplay::is_empty), watch.lap(),
             wall_statistics(request, displays),
             fmt::format("{} .. {}", displays.front().path, displays.back().path));
    });
  };
  const auto render = [&](comm::Communicator& communicator) {
    std::shared_ptr<const Prepared> prepared = shared;
    if (!prepared) {
      communicator.mark(comm::Phase::load, 0);
      comm::all_or_none(communicator, comm::Phase::load, [&] {
        if (communicator.rank() == 0) prepare_outputs(request, video);
      });
      prepared = prepare(communicator, request, progress);
      comm::all_or_none(communicator, comm::Phase::load, [&] {
        if (communicator.rank() == 0) refuse_overwriting(request, prepared->scene.files);
      });
      comm::handshake(communicator, scene_facts(*prepared));
    }
    if (!prepared->cameras.empty()) {
      const Animation animation =
          render_animation(communicator, *prepared, request, session, progress);
      comm::all_or_none(communicator, comm::Phase::other, [&] {
        if (communicator.rank() != 0) return;
        if (video) video->encode(session);
        bar.end();
        finish(request, *prepared, animation);
      });
      return;
    }
    if (!request.layout.has_displays()) {
      const std::vector<geometry::Rect> bands = choose_bands(communicator, request);
      if (bands.size() > 1 || request.layout.one_file) {
        render_in_bands(communicator, *prepared, bands);
        return;
      }
    }
    Frames frames =
        render_frames(communicator, *prepared, request, progress, [&](Picture&& picture) {
          put_background_behind(request, *prepared, prepared->camera, request.window, picture);
          write_picture(session, request.output, picture);
        });
    if (request.layout.has_displays()) {
      write_wall(communicator, *prepared, frames);
      return;
    }
    comm::all_or_none(communicator, comm::Phase::other, [&] {
      if (communicator.rank() != 0) return;
      bar.end();
      finish(request, session, *prepared, frames);
    });
  };
  run_ranks(session, request.launch, inputs_of(request), render, Waiting::stops);
  return kDone;
}

}  // namespace

void add_render(CLI::App& program, Session& session) {
  CLI::App* command =
      program.add_subcommand("render", "Render a picture of a scene, mesh or points");
  const auto request = std::make_shared<RenderRequest>();
  add_render_options(*command, *request);
  add_metadata_option(*command, session);
  add_common_options(
      *command, session,
      "render model.glb -o model.png --engine raytrace --integrator path --noise 0.01 "
      "--time 20 --denoise --tone filmic\n"
      "render points.las -o relief.png --color-by z --view iso");
  command->callback([&session, request, command] {
    session.run = [&session, request, command] { return run(session, *command, *request); };
  });
}

}  // namespace delray::apps
