// Each engine is made when it is first wanted, and looks at one request that changes from frame to
// frame.
#include "apps/view/rank_frames.h"

#include <algorithm>

#include "apps/render/write_picture.h"
#include "comm/collectives.h"
#include "raster/strategies.h"

namespace delray::apps::view {
namespace {

// Samples of a coarse picture by rays.
constexpr int kCoarseSamples = 4;

Json json_of(const glm::vec3& v) { return {v.x, v.y, v.z}; }
glm::vec3 vector_of(const Json& json) {
  return {json[0].get<float>(), json[1].get<float>(), json[2].get<float>()};
}

// A pack is read while it is drawn, as most scenes that are packed have no room in memory.
void check_pack(const RenderRequest& request) {
  if (is_raytrace(request))
    throw UsageError("--engine raytrace: view reads a pack in parts, which the rasterizer can");
  if (!raster::find_strategy(request.raster.strategy)->packs || !request.sharing.schedule.empty()) {
    throw UsageError(
        "view reads a pack in parts, which sort-last and sort-first without a schedule can");
  }
}

std::string text_of(const Job& job) {
  const scenes::Camera& c = job.camera;
  return Json({{"kind", static_cast<int>(job.kind)},
               {"options", job.options},
               {"eye", json_of(c.eye)},
               {"at", json_of(c.at)},
               {"up", json_of(c.up)},
               {"lens", {c.vertical_fov, c.near, c.aperture, c.focus, c.height, c.far}},
               {"size", {job.width, job.height}},
               {"figures", job.figures},
               {"coarse", job.is_coarse}})
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

Job job_of(std::string_view text) {
  const Json json = Json::parse(text);
  Job job;
  job.kind = static_cast<Job::Kind>(json["kind"].get<int>());
  job.options = json["options"].get<Options>();
  scenes::Camera& c = job.camera;
  c.eye = vector_of(json["eye"]);
  c.at = vector_of(json["at"]);
  c.up = vector_of(json["up"]);
  float* const lens[] = {&c.vertical_fov, &c.near, &c.aperture, &c.focus, &c.height, &c.far};
  for (std::size_t i = 0; i < std::size(lens); ++i) *lens[i] = json["lens"][i].get<float>();
  job.width = json["size"][0].get<int>();
  job.height = json["size"][1].get<int>();
  job.figures = json["figures"].get<bool>();
  job.is_coarse = json["coarse"].get<bool>();
  return job;
}

}  // namespace

Job broadcast(comm::Communicator& communicator, const Job& job) {
  if (communicator.size() == 1) return job;
  comm::Buffer message;
  if (communicator.rank() == 0) {
    const std::string text = text_of(job);
    message = comm::Buffer::of(std::span<const char>(text));
  }
  message = comm::broadcast(communicator, 0, std::move(message));
  const std::span<const char> text = message.as<char>();
  return job_of({text.data(), text.size()});
}

bool RankFrames::has_to_build(const Job& job) const {
  return !prepared_->tracer && option_of(job.options, "--engine") == "raytrace";
}

void RankFrames::begin(const Job& job) {
  if (!options_ || *options_ != job.options) {
    options_.reset();
    Options options = job.options;
    request_ = make_request(input_, options);
    if (prepared_->pack) check_pack(request_);
    request_.legend = request_.legend && prepared_->scene.colour_scale.has_value();
    options_ = job.options;
  }
  set_size(job.width, job.height, request_);
  request_.statistics = job.figures ? "-" : "";  // partitions are reported where somebody looks
  if (job.is_coarse)
    request_.raytrace.samples = std::min(request_.raytrace.samples, kCoarseSamples);
  if (job.is_coarse) options_.reset();
  if (!owns_scene_) return;
  if (is_raytrace(request_) && !prepared_->tracer) add_tracer(request_, *prepared_);
  follow_camera(request_, job.camera, *prepared_);
}

Frame RankFrames::render(comm::Communicator& communicator, const Job& job, Growth* growth) {
  std::optional<FrameRenderer>& engine = is_raytrace(request_) ? rays_ : raster_;
  if (!engine) engine.emplace(communicator, *prepared_, request_, progress_);
  engine->set_growth(is_raytrace(request_) ? growth : nullptr);
  Frame frame = engine->render(communicator, job.camera);
  // What ranks of a process share changes before the next frame.
  if (communicator.size() > 1) comm::barrier(communicator);
  const bool is_left = growth != nullptr && is_raytrace(request_) && !growth->is_done;
  if (communicator.rank() == 0 && !is_left) finish(job, frame.picture);
  return frame;
}

void RankFrames::finish(const Job& job, Picture& picture) const {
  put_background_behind(request_, *prepared_, job.camera, request_.window, picture);
}

}  // namespace delray::apps::view
