// One frame on a rank: checks options and camera, runs the strategy, and gathers statistics; whole
// or in steps that may overlap with those of other frames.
//
// Degenerate: a single rank's depths are distances already; a share is drawn by a communicator that
// nobody else is in.
#include "raster/render.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <mutex>
#include <stdexcept>

#include "comm/collectives.h"
#include "comm/ledger.h"
#include "comm/recording.h"
#include "composite/codec.h"
#include "composite/scheme.h"
#include "loadbalance/partition.h"
#include "raster/distribute/frame_memory.h"
#include "raster/distribute/frame_report.h"
#include "raster/distribute/rank_context.h"
#include "raster/distribute/share_communicator.h"
#include "raster/packed/packed_scene.h"
#include "raster/pipeline/samples.h"
#include "raster/shading/eye_dome.h"
#include "raster/strategies.h"

namespace delray::raster {
namespace {

void check(const RenderOptions& options, int ranks) {
  const auto known = [](bool found, const char* kind, const std::string& name) {
    if (!found) throw std::invalid_argument("there is no " + std::string(kind) + " '" + name + "'");
  };
  const Strategy* strategy = find_strategy(options.strategy);
  known(strategy != nullptr, "strategy", options.strategy);
  known(composite::find_scheme(options.scheme) != nullptr, "compositing scheme", options.scheme);
  known(composite::find_codec(options.codec) != nullptr, "codec", options.codec);
  known(loadbalance::find_partitioner(options.partition) != nullptr, "partition",
        options.partition);
  const int n = options.supersampling;
  if (n != 1 && n != 2 && n != 4)
    throw std::invalid_argument("a pixel has 1, 2 or 4 samples in either direction");
  const int longest = std::max(options.width, options.height);
  if (std::min(options.width, options.height) < 1 || longest > kLargestSide / n) {
    throw std::invalid_argument("a picture's sides are from 1 to " + std::to_string(kLargestSide) +
                                " samples");
  }
  const geometry::Rect frame{0, 0, options.width, options.height};
  const geometry::Rect& window = options.window;
  if (window != geometry::Rect() &&
      (window.empty() || geometry::intersection(window, frame) != window))
    throw std::invalid_argument("a window has pixels of the frame");
  if (options.eye_dome && (!window.empty() || !options.displays.empty()))
    throw std::invalid_argument("eye-dome lighting is for whole frames on one rank");
  for (const loadbalance::Region& display : options.displays) {
    if (display.rect.empty() || display.owner < 0 || display.owner >= ranks ||
        geometry::intersection(display.rect, frame) != display.rect)
      throw std::invalid_argument("a display has pixels of the frame and a rank that shows it");
  }
  if (options.owners_draw && (options.displays.empty() || !strategy->displays ||
                              !options.schedule.empty() || options.groups != Groups::one)) {
    throw std::invalid_argument("only sort-first and sort-middle of one group draw by displays");
  }
  if (!options.schedule.empty()) {
    known(loadbalance::find_schedule(options.schedule) != nullptr, "schedule", options.schedule);
    if (!strategy->schedules || options.block < 1)
      throw std::invalid_argument("schedules hand out sort-first's blocks of at least a pixel");
  }
  if (options.regions_per_rank < 1 || !(options.keep_factor >= 1)) {
    throw std::invalid_argument(
        "a rank has at least one region, kept up to a factor of at least 1");
  }
  if (options.shade == Shade::composited &&
      (!strategy->composites || options.lighting != Lighting::phong))
    throw std::invalid_argument("only sort-last shades after compositing, and only with phong");
  if (options.blend == Blend::by_cell &&
      (!strategy->composites || options.shade == Shade::composited))
    throw std::invalid_argument("only sort-last blends by cell, and after shading");
  if (options.geometry_ranks < 0 ||
      (options.geometry_ranks > 0 && (options.groups != Groups::two || !strategy->groups)))
    throw std::invalid_argument("ranks for geometry are of two groups, with sort-middle");
  if (options.groups == Groups::two && ranks > 1 && options.geometry_ranks >= ranks) {
    throw std::invalid_argument("of " + std::to_string(ranks) + " ranks " +
                                std::to_string(ranks - 1) +
                                " at most can be for geometry, since others have to draw");
  }
}

bool is_finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Throws std::invalid_argument for a camera that sees nothing but NaN.
void check(const scenes::Camera& camera) {
  if (!is_finite(camera.eye) || !is_finite(camera.at) || !is_finite(camera.up) ||
      !(camera.vertical_fov > 0 && camera.vertical_fov < 180) || !(camera.near >= 0) ||
      !(camera.aperture >= 0) || !(camera.focus >= 0) ||
      !std::isfinite(camera.near + camera.aperture + camera.focus + camera.height + camera.far)) {
    throw std::invalid_argument(
        "a camera has finite places, an angle from 0 to 180 degrees, and no negative distances");
  }
}

// The options of a frame that is the window; those of all of one have no window any more.
RenderOptions options_of_window(const RenderOptions& options) {
  RenderOptions result = options;
  if (options.window.empty()) return result;
  result.width = options.window.width();
  result.height = options.window.height();
  return result;
}

Screen screen_of(const scenes::Camera& camera, const RenderOptions& options) {
  const int n = options.supersampling;
  const geometry::Rect all{0, 0, options.width, options.height};
  Screen screen = make_screen(scenes::make_view(camera, options.width * n, options.height * n),
                              samples_of(options.window.empty() ? all : options.window, n));
  screen.samples = static_cast<float>(n);
  return screen;
}

// Scratch memory for frames in steps, several of which may be under way. Any thread.
class ScratchPool {
 public:
  std::unique_ptr<Scratch> take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return std::make_unique<Scratch>();
    std::unique_ptr<Scratch> taken = std::move(free_.back());
    free_.pop_back();
    return taken;
  }
  void give_back(std::unique_ptr<Scratch> scratch) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(scratch));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Scratch>> free_;  // what was used last is taken first
};

}  // namespace

struct Renderer::Memory {
  PreparedScene scene;
  Scratch scratch = {};
  FrameMemory memory = {};
  ScratchPool pool = {};
  std::unique_ptr<PackedScene> packed = {};
};

struct Renderer::Frame {
  // `scratch` is the frame's until it is rasterized.
  Frame(Memory& memory, Scratch& scratch, comm::Communicator& communicator,
        const scenes::Camera& camera, const RenderOptions& whole, parallel::Progress* progress)
      : options((check(whole, communicator.size()), check(camera), check_packed(memory, whole),
                 check_parts(memory, whole), options_of_window(whole))),
        screen(screen_of(camera, whole)),
        recording(communicator, events),
        rank{recording, memory.scene, screen, options, progress, scratch, memory.memory} {
    // A frame that changes the picture's memory without saying what is clear, or has another's,
    // leaves nothing known of it.
    scratch.taken = std::exchange(scratch.clear_in, nullptr);
  }

  const Strategy& strategy() const { return *find_strategy(options.strategy); }

  FrameReport report() const { return make_report(rank, events); }

  // Collective.
  Result finish(comm::Communicator& communicator, Picture&& picture) {
    Result result{std::move(picture), std::move(rank.shown), {}};
    result.statistics = gather_statistics(communicator, report(), rank.prepared.packed != nullptr);
    if (communicator.rank() == 0 && options.strategy != "sort-last")
      result.statistics.partition = partition_of_ranks();
    if (options.eye_dome) {
      std::visit([&](auto& image) { light_by_eye_dome(view_of_pixels(), image); }, result.picture);
    }
    return result;
  }

  // The screen is in samples.
  scenes::View view_of_pixels() const {
    scenes::View view = screen.view;
    view.width = options.width;
    view.height = options.height;
    view.scale /= screen.samples;
    return view;
  }

  static void check_packed(const Memory& memory, const RenderOptions& options) {
    if (memory.packed == nullptr) return;
    if (!find_strategy(options.strategy)->packs || !options.schedule.empty() ||
        options.blend == Blend::by_cell || !options.displays.empty()) {
      throw std::invalid_argument(
          "packs are rendered by sort-first and sort-last, without schedules, cells and displays");
    }
  }

  static void check_parts(const Memory& memory, const RenderOptions& options) {
    if (!memory.scene.is_part) return;
    if (!find_strategy(options.strategy)->parts || options.groups != Groups::one ||
        options.blend == Blend::by_cell) {
      throw std::invalid_argument(
          "scenes in parts are rendered by sort-last and sort-middle, without groups and cells");
    }
  }

  std::optional<PartitionStatistics> partition_of_ranks() const {
    std::optional<PartitionStatistics> statistics = rank.memory.screen.statistics();
    if (!statistics || rank.rank_of_owner.empty()) return statistics;
    for (loadbalance::Region& region : statistics->partition.regions)
      region.owner = rank.rank_of_owner[region.owner];
    const std::vector<double> loads = statistics->loads;
    for (std::size_t owner = 0; owner < loads.size(); ++owner)
      statistics->loads[rank.rank_of_owner[owner]] = loads[owner];
    return statistics;
  }

  const RenderOptions options;
  const Screen screen;
  std::vector<comm::Event> events;
  comm::Recording recording;
  RankContext rank;
};

class Renderer::Steps final : public FrameInSteps {
 public:
  Steps(Memory& memory, comm::Communicator& communicator, const scenes::Camera& camera,
        const RenderOptions& options, const parallel::Progress* whole)
      : memory_(memory),
        communicator_(communicator),
        scratch_(memory.pool.take()),
        progress_(whole),
        frame_(memory, *scratch_, communicator, camera, options, &progress_),
        steps_(frame_.strategy().steps(frame_.rank)) {
    frame_.rank.in_steps = true;
  }

  void transform() override { steps_->transform(); }
  void rasterize() override {
    steps_->rasterize();
    memory_.pool.give_back(std::move(scratch_));
  }
  Result compose() override {
    comm::Communicator& recording = frame_.recording;
    recording.mark(comm::Phase::rasterize, 0);
    frame_.rank.report_work(frame_.rank.counts);
    return frame_.finish(communicator_, steps_->compose());
  }

 private:
  Memory& memory_;
  comm::Communicator& communicator_;
  std::unique_ptr<Scratch> scratch_;  // until it is rasterized
  parallel::Progress progress_;
  Frame frame_;
  std::unique_ptr<FrameSteps> steps_;
};

Renderer::Renderer(const scenes::Scene& scene, std::shared_ptr<const shading::Shader> shader) {
  memory_ = std::unique_ptr<Memory>(new Memory{PreparedScene(scene, std::move(shader))});
}
Renderer::Renderer(comm::Communicator& communicator, const scenes::ScenePart& part,
                   std::shared_ptr<const shading::Shader> shader) {
  memory_ =
      std::unique_ptr<Memory>(new Memory{PreparedScene(communicator, part, std::move(shader))});
}
Renderer::Renderer(const packs::PackReader& pack, const scenes::Scene& scene,
                   const PackMemory& memory, std::shared_ptr<const shading::Shader> shader)
    : Renderer(scene, std::move(shader)) {
  memory_->packed = std::make_unique<PackedScene>(pack, memory);
  memory_->scene.packed = memory_->packed.get();
}
void Renderer::recycle(Picture&& picture) {
  // Ranks that are not shown the picture keep memory of their own.
  const bool is_empty = std::visit([](const auto& image) { return image.width == 0; }, picture);
  if (!is_empty) memory_->scratch.spare = std::move(picture);
}
void Renderer::follow(const scenes::Movement& movement) {
  if (movement.instances.empty() && movement.meshes.empty()) return;
  for (const std::uint32_t mesh : movement.meshes) memory_->scene.clusters.forget(mesh);
  FrameMemory& memory = memory_->memory;
  memory.screen.forget_places();
  for (GroupTraffic* traffic : {&memory.sorted_first.traffic, &memory.shared_out.traffic})
    traffic->moved(movement);
  memory.sorted_middle = {};
  memory.cells = {};
}

Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Result Renderer::render(comm::Communicator& communicator, const scenes::Camera& camera,
                        const RenderOptions& options, parallel::Progress* progress) {
  Frame frame(*memory_, memory_->scratch, communicator, camera, options, progress);
  if (!options.displays.empty() && frame.strategy().composites)
    return composite_displays(communicator, camera, options, progress);
  return frame.finish(communicator, frame.strategy().render(frame.rank));
}

// Every display is a frame that all ranks draw and that its owner gets.
Result Renderer::composite_displays(comm::Communicator& communicator, const scenes::Camera& camera,
                                    const RenderOptions& options, parallel::Progress* progress) {
  Result result;
  FrameReport all{};
  all.rank.rank = communicator.rank();
  RenderOptions of_display = options;
  for (const loadbalance::Region& display : options.displays) {
    of_display.window = display.rect;
    Frame frame(*memory_, memory_->scratch, communicator, camera, of_display, progress);
    frame.rank.root = display.owner;
    Picture picture = frame.strategy().render(frame.rank);
    if (display.owner == communicator.rank()) result.shown.push_back(std::move(picture));
    all += frame.report();
  }
  result.statistics = gather_statistics(communicator, all, false);
  return result;
}

bool Renderer::has_steps(const RenderOptions& options, int ranks) {
  check(options, ranks);
  return find_strategy(options.strategy)->steps != nullptr && options.displays.empty();
}

std::unique_ptr<FrameInSteps> Renderer::begin(comm::Communicator& communicator,
                                              const scenes::Camera& camera,
                                              const RenderOptions& options,
                                              const parallel::Progress* progress) {
  return std::make_unique<Steps>(*memory_, communicator, camera, options, progress);
}

PartialImage Renderer::draw_share(int rank, int ranks, const scenes::Camera& camera,
                                  const RenderOptions& options, parallel::Progress* progress) {
  assert(options.supersampling == 1);
  ShareCommunicator communicator(rank, ranks);
  Frame frame(*memory_, memory_->scratch, communicator, camera, options, progress);
  return sort_last_share(frame.rank);
}

loadbalance::Costs Renderer::costs(int regions, const scenes::Camera& camera,
                                   const RenderOptions& clip) {
  RenderOptions options = clip;
  options.costs = CostSource::model;
  ShareCommunicator communicator(0, 1);
  Frame frame(*memory_, memory_->scratch, communicator, camera, options, nullptr);
  return ScreenPartition().costs(frame.rank, regions);
}

Result render(comm::Communicator& communicator, const scenes::Scene& scene,
              const scenes::Camera& camera, const RenderOptions& options,
              parallel::Progress* progress) {
  return Renderer(scene).render(communicator, camera, options, progress);
}

}  // namespace delray::raster
