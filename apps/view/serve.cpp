// Rank 0 takes task after task and has all ranks render; the others do what they are told.
//
// A picture that grows is asked 30 times a second whether something else is due; what it has so far
// is kept for when its turn comes again.
#include "apps/view/serve.h"

#include <algorithm>
#include <limits>
#include <map>

#include "apps/render/options/camera_options.h"
#include "apps/view/figures.h"
#include "apps/view/picked.h"
#include "comm/collectives.h"
#include "packs/extent.h"
#include "raytrace/film.h"
#include "scenes/extent.h"
#include "scenes/framing.h"

namespace delray::apps::view {
namespace {

// A page's picture that grows.
struct Growing {
  std::uint64_t version = 0;
  Growth growth;
};

class Root {
 public:
  Root(comm::Communicator& communicator, const Serving& serving, RankFrames& frames)
      : communicator_(communicator), serving_(serving), frames_(frames) {}

  Job::Kind run() {
    const double patience = serving_.most_silence > 0 ? serving_.most_silence / 4
                                                      : std::numeric_limits<double>::infinity();
    for (;;) {
      const Task task = serving_.viewers->next(*serving_.progress, patience);
      switch (task.kind) {
        case Task::Kind::picture:
          render(task);
          break;
        case Task::Kind::pick:
          serving_.viewers->tell(task.page, picked(task, *serving_.prepared));
          break;
        case Task::Kind::place:
          place(task);
          break;
        case Task::Kind::nothing:
          broadcast(communicator_, Job());
          break;
        case Task::Kind::reload:
          return end(Job::Kind::reload);
        case Task::Kind::take:
          return end(Job::Kind::take);
        case Task::Kind::restart:
          return end(Job::Kind::restart);
        case Task::Kind::end:
          return end(Job::Kind::end);
      }
    }
  }

 private:
  Job::Kind end(Job::Kind kind) {
    Job job;
    job.kind = kind;
    return broadcast(communicator_, job).kind;
  }

  void tell(PageId page, const std::string& error) {
    serving_.viewers->tell(page, {{"type", "error"}, {"text", error}});
  }

  void place(const Task& task) {
    try {
      const bool is_named = !task.view.empty();
      const double clip = is_named ? 0.0 : task.order.look->still.camera.clip;
      serving_.viewers->place(task.page, camera_for(task, *serving_.prepared),
                              static_cast<float>(clip));
    } catch (const std::invalid_argument& error) {
      tell(task.page, error.what());
    }
  }

  // What a page can be told is wrong is found before the other ranks hear of the picture.
  bool begin(const Task& task, const Job& job) {
    const bool builds = frames_.has_to_build(job);
    if (builds) serving_.viewers->set_progress("Building what rays need", 0, 0);
    try {
      frames_.begin(job);
      if (builds) serving_.viewers->set_progress("", 0, 0);
      return true;
    } catch (const std::bad_alloc&) {
      tell(task.page, "out of memory");
    } catch (const std::runtime_error& error) {
      tell(task.page, error.what());
    } catch (const std::invalid_argument& error) {
      tell(task.page, error.what());
    }
    if (builds) serving_.viewers->set_progress("", 0, 0);
    serving_.viewers->done(task, 0, true);
    return false;
  }

  void render(const Task& task) {
    Stopwatch watch;
    Job job;
    job.kind = Job::Kind::picture;
    job.options = task.order.options();
    job.camera = task.order.camera;
    job.width = task.order.width;
    job.height = task.order.height;
    job.figures = task.order.figures;
    job.is_coarse = task.order.stage == Stage::coarse;
    if (!begin(task, job)) return;
    broadcast(communicator_, job);

    const bool grows = task.order.stage == Stage::still && is_raytrace(frames_.request());
    Growing* const growing = grows ? &growing_of(task) : nullptr;
    FrameFacts facts{task.order.stage, task.order.camera_number};
    if (growing != nullptr) watch_growth(task, job, facts, growing->growth);
    Frame frame = frames_.render(communicator_, job, growing ? &growing->growth : nullptr);
    facts.render_seconds = watch.lap();
    const bool is_left = growing != nullptr && !growing->growth.is_done;
    if (!is_left) {
      facts.is_complete = task.order.stage == Stage::still;
      facts.samples = frame.extras.samples;
      serving_.sender->send(task.page, facts, std::move(frame.picture));
      growing_.erase(task.page);
    }
    if (task.order.figures)
      serving_.viewers->tell(task.page, figures_of(frame.statistics, job.width, job.height));
    serving_.viewers->done(task, facts.render_seconds, !is_left);
  }

  Growing& growing_of(const Task& task) {
    std::erase_if(growing_,
                  [&](const auto& one) { return !serving_.viewers->is_there(one.first); });
    Growing& growing = growing_[task.page];
    if (growing.version != task.order.version) growing = {task.order.version, {}};
    return growing;
  }

  // Every pass is shown, until the last one or until somebody wants something else.
  void watch_growth(const Task& task, const Job& job, FrameFacts facts, Growth& growth) {
    facts.is_complete = false;
    const auto watch = std::make_shared<Stopwatch>();
    const auto seconds = std::make_shared<double>(0);
    growth.goes_on = [this, task, watch, seconds] {
      *seconds += watch->lap();
      return !serving_.progress->stop_requested() && !serving_.viewers->is_outdone(task, *seconds);
    };
    growth.show = [this, task, job, facts](Picture&& picture, double samples) mutable {
      facts.samples = samples;
      frames_.finish(job, picture);
      serving_.sender->send(task.page, facts, std::move(picture));
    };
  }

  comm::Communicator& communicator_;
  const Serving& serving_;
  RankFrames& frames_;
  std::map<PageId, Growing> growing_;
};

Job::Kind follow(comm::Communicator& communicator, RankFrames& frames) {
  for (;;) {
    const Job job = broadcast(communicator, {});
    if (job.kind == Job::Kind::wait) continue;
    if (job.kind != Job::Kind::picture) return job.kind;
    frames.begin(job);
    // As rank 0 has one, whose functions are the ones that are called.
    Growth growth;
    growth.goes_on = [] { return true; };
    growth.show = [](Picture&&, double) {};
    frames.render(communicator, job, job.is_coarse ? nullptr : &growth);
  }
}

scenes::FarthestPoints farthest_points(const Prepared& prepared) {
  return prepared.pack ? packs::farthest_points(*prepared.pack)
                       : scenes::farthest_points(prepared.scene);
}

}  // namespace

scenes::Camera camera_for(const Task& task, const Prepared& prepared) {
  CameraOptions options = task.order.look->still.camera;
  if (!task.view.empty()) options = {"", task.view};
  const float aspect = static_cast<float>(task.order.width) / static_cast<float>(task.order.height);
  return choose_camera(options, prepared.scene, farthest_points(prepared), aspect);
}

Json facts_of(const RenderRequest& request, const Prepared& prepared) {
  const geometry::Box3 box = scenes::bounds(farthest_points(prepared));
  const glm::dvec3& origin = prepared.scene.origin;
  const glm::vec3 size = box.size(), centre = box.empty() ? glm::vec3(0) : box.centre();
  return {{"type", "scene"},
          {"name", request.scene.file.path},
          {"triangles", prepared.triangles},
          {"points", prepared.points},
          {"vertices", prepared.vertices},
          {"instances", prepared.pack ? 0 : prepared.scene.instances.size()},
          {"origin", {origin.x, origin.y, origin.z}},
          {"centre", {centre.x, centre.y, centre.z}},
          {"size", glm::length(size)},
          {"z_up", prepared.scene.z_up},
          {"views", scenes::view_names()}};
}

Job::Kind serve(comm::Communicator& communicator, const Serving& serving) {
  parallel::Progress frame_progress;  // a frame is not stopped halfway: others wait for its rank
  const bool owns_scene = !serving.shares_memory || communicator.rank() == 0;
  RankFrames frames(serving.prepared, serving.input, &frame_progress, owns_scene);
  if (communicator.rank() == 0) return Root(communicator, serving, frames).run();
  return follow(communicator, frames);
}

}  // namespace delray::apps::view
