// One frame on a rank: checks options, has a schedule hand out tiles, traces them, and collects
// pixels, costs and statistics on rank 0.
//
// Over a scene that every rank has, threads trace tiles by themselves; over one that is
// distributed, the rank's threads work together at several tiles at a time. Degenerate: a frame
// without pixels has no tiles; parts that are not rendered stay clear.
#include "raytrace/render.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "comm/recording.h"
#include "loadbalance/partition.h"
#include "parallel/arena.h"
#include "raytrace/distributed/collect_tiles.h"
#include "raytrace/distributed/distributed_tracer.h"
#include "raytrace/distributed/ray_pool.h"
#include "raytrace/distributed/serving_communicator.h"
#include "raytrace/distributed/tile_plan.h"
#include "raytrace/distributed/tile_shares.h"
#include "raytrace/integrators/sample_tile.h"

namespace delray::raytrace {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void check(const RenderOptions& options) {
  if (loadbalance::find_schedule(options.schedule) == nullptr)
    throw std::invalid_argument("there is no schedule '" + options.schedule + "'");
  if (!options.partition.empty() && loadbalance::find_partitioner(options.partition) == nullptr)
    throw std::invalid_argument("there is no partition '" + options.partition + "'");
  if (options.tile < 0) throw std::invalid_argument("the side of a tile is not negative");
  if (options.width < 0 || options.height < 0 || options.samples < 1 || options.trace.depth < 0 ||
      options.regions_per_rank < 1 || !(options.keep_factor >= 1) || options.part.samples < 0 ||
      options.part.first_sample < 0) {
    throw std::invalid_argument(
        "sizes, samples, depth and regions of a picture are not negative, nor is there less than "
        "a sample, a region for each rank and an equal share to keep");
  }
  const geometry::Rect frame{0, 0, options.width, options.height};
  if (!options.part.window.empty() &&
      !(geometry::intersection(options.part.window, frame) == options.part.window))
    throw std::invalid_argument("the window lies outside of the frame");
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

// The tiles that this rank gets, and what the schedule says of it.
struct Traced {
  std::vector<TilePixels> tiles;
  loadbalance::RankReport report;
  RoutingCounts routing = {};
  RayCounts rays = {};
  double busy = 0.0;  // seconds of processor time
};

// Rasterizes first hits, where that is asked for and pays.
FirstHits::Made first_hits(const comm::Communicator& communicator, const Tracer* tracer,
                           const RenderOptions& options, const FrameContext& context,
                           const geometry::Rect& window, FirstHits::Trials& trials) {
  if (options.primary == Primary::trace || tracer == nullptr) return {};
  const scenes::View& view = context.view;
  SeenWindow seen{view, window};
  for (const float x : {0.0F, static_cast<float>(view.width)}) {
    for (const float y : {0.0F, static_cast<float>(view.height)}) {
      if (!view.orthographic)
        seen.longest = std::max(seen.longest, 1.001F * glm::length(view.ray(x, y)));
    }
  }
  seen.centred = options.samples == 1;
  double part = 1.0;
  if (const auto squares = options.part.squares; !squares.empty()) {
    part = static_cast<double>(std::ranges::count(squares, std::uint8_t{1})) /
           static_cast<double>(squares.size());
  }
  return FirstHits::make(*tracer, seen, part * samples_of(options) / communicator.size(),
                         options.primary == Primary::raster_always, trials);
}

// Of schedules that divide tiles.
Traced trace_pool(comm::Communicator& communicator, const TiledFrame& frame,
                  const loadbalance::Schedule& schedule, loadbalance::ScheduleOptions how) {
  parallel::Progress* const progress = frame.options.progress;
  if (progress != nullptr && communicator.rank() == 0) progress->start(frame.tiles.grid().count());
  RayPool pool(communicator, frame);
  how.divisible = &pool;
  Traced traced;
  traced.report = schedule.run(communicator, frame.tiles.grid(), how, [&](std::uint32_t tile, int) {
    pool.begin(tile);
    if (progress != nullptr) progress->advance();
  });
  traced.tiles = std::move(pool.tiles());
  traced.rays = pool.rays();
  traced.busy = pool.busy();
  return traced;
}

Traced trace(comm::Communicator& communicator, const TiledFrame& frame,
             const loadbalance::ScheduleOptions& how) {
  const loadbalance::Schedule& schedule = *loadbalance::find_schedule(frame.options.schedule);
  if (schedule.divides) return trace_pool(communicator, frame, schedule, how);
  parallel::Progress* const progress = frame.options.progress;
  // Ranks of one process may have one progress in common.
  if (progress != nullptr && communicator.rank() == 0) progress->start(frame.tiles.grid().count());
  struct alignas(64) OfThread {
    std::unique_ptr<WavefrontIntegrator> integrator;
    std::vector<TilePixels> tiles;
  };
  std::vector<OfThread> by_thread(static_cast<std::size_t>(how.threads));
  const auto trace_tile = [&](std::uint32_t tile, int thread) {
    OfThread& mine = by_thread[thread];
    if (!mine.integrator) mine.integrator = frame.integrators.take();
    const TilePixels& done = mine.tiles.emplace_back(sample_tile(frame, tile, *mine.integrator));
    if (thread == 0) communicator.work(comm::Work::rays, done.rays.sent());
    if (progress != nullptr) progress->advance();
  };
  Traced traced;
  traced.report = schedule.run(communicator, frame.tiles.grid(), how, trace_tile);
  for (std::size_t thread = 0; thread < by_thread.size(); ++thread) {
    for (TilePixels& tile : by_thread[thread].tiles) {
      if (thread > 0) communicator.work(comm::Work::rays, tile.rays.sent());
      traced.busy += tile.busy;
      traced.rays += tile.rays;
      traced.tiles.push_back(std::move(tile));
    }
  }
  return traced;
}

// What a rank's tiles of a frame took, of a grid of tiles.
struct PlannedTiles {
  std::vector<PlannedTile> tiles;
  geometry::Rect frame;
  int width = 0;
};

// As above, where the scene is shared out: the rank's threads work together at several tiles.
Traced trace(comm::Communicator& communicator, const TiledFrame& frame, SharedScene& scene,
             const Distribution& distribution, PlannedTiles& planned,
             loadbalance::ScheduleOptions how) {
  parallel::Progress* const progress = frame.options.progress;
  if (progress != nullptr && communicator.rank() == 0) progress->start(frame.tiles.grid().count());
  std::vector<std::int32_t> plan;
  if (distribution.plans_tiles && communicator.size() > 1) {
    const bool same = planned.frame == frame.tiles.frame && planned.width == frame.tiles.width;
    plan = plan_tiles(communicator, same ? planned.tiles : std::vector<PlannedTile>(),
                      frame.tiles.grid().count(), distribution.uneven);
  }
  DistributedTracer tracer(communicator, scene, distribution, frame, plan);
  ServingCommunicator serving(communicator, tracer);
  how.threads = 1;
  Traced traced;
  traced.report = loadbalance::find_schedule(frame.options.schedule)
                      ->run(serving, frame.tiles.grid(), how,
                            [&](std::uint32_t tile, int) { tracer.add(tile); });
  tracer.finish();
  traced.tiles = std::move(tracer.tiles());
  for (const TilePixels& tile : traced.tiles) traced.rays += tile.rays;
  planned = {tracer.take_planned(), frame.tiles.frame, frame.tiles.width};
  traced.routing = tracer.counts();
  traced.busy = tracer.busy();
  return traced;
}

RankStatistics statistics_of(Traced& traced, const comm::Totals& totals) {
  RankStatistics mine;
  mine.rays = traced.rays;
  mine.busy = traced.busy;
  mine.rays_sent = traced.routing.rays_sent;
  mine.answers_sent = traced.routing.answers_sent;
  mine.tests = traced.routing.tests;
  mine.clusters_fetched = traced.routing.clusters_fetched;
  mine.clusters_fetched_bytes = traced.routing.cluster_bytes;
  mine.clusters_moved = traced.routing.clusters_moved;
  mine.tasks = traced.tiles.size();
  mine.idle = traced.report.idle;
  mine.requests = traced.report.requests;
  mine.steals = traced.report.steals;
  mine.tasks_stolen = traced.report.tasks_stolen;
  mine.rays_stolen = traced.report.units_stolen;
  mine.bytes_sent = totals.bytes_sent;
  mine.bytes_received = totals.bytes_received;
  mine.messages = totals.messages_sent;
  mine.timeline = std::move(traced.report.timeline);
  return mine;
}

// Adds what is known of the scene, which every rank has or which is shared out; of that one
// `dropped` clusters had been dropped before the frame.
void add_scene(const Tracer& tracer, RankStatistics& mine, Statistics& statistics) {
  statistics.build_seconds = tracer.build_seconds;
  statistics.degenerate = tracer.degenerate;
  statistics.structure_bytes = tracer.embree.memory();
  statistics.embree_version = tracer.embree.device().version();
  statistics.embree_isa = tracer.embree.device().isa();
  mine.geometry_bytes = tracer.bytes;
}
void add_scene(const SharedScene& scene, std::uint64_t dropped, RankStatistics& mine,
               Statistics& statistics) {
  statistics.build_seconds = scene.build_seconds();
  statistics.degenerate = scene.degenerate();
  statistics.structure_bytes = scene.bytes();
  statistics.embree_version = scene.embree_version();
  statistics.embree_isa = scene.embree_isa();
  mine.clusters_dropped = scene.evicted() - dropped;
  mine.clusters = scene.owned().size();
  mine.tree_bytes = scene.tree_bytes();
  mine.geometry_bytes = scene.most_bytes();
}

void summarize(std::vector<RankStatistics>&& ranks, Statistics& statistics) {
  std::vector<double> rays;
  for (const RankStatistics& rank : ranks) {
    statistics.rays += rank.rays;
    rays.push_back(static_cast<double>(rank.rays.sent()));
  }
  statistics.imbalance_rays = loadbalance::imbalance(rays);
  statistics.ranks = std::move(ranks);
}

}  // namespace

void RankStatistics::operator+=(RankStatistics&& more) {
  busy += more.busy;
  idle += more.idle;
  tasks += more.tasks;
  rays += more.rays;
  bytes_sent += more.bytes_sent;
  bytes_received += more.bytes_received;
  messages += more.messages;
  requests += more.requests;
  steals += more.steals;
  tasks_stolen += more.tasks_stolen;
  rays_stolen += more.rays_stolen;
  rays_sent += more.rays_sent;
  answers_sent += more.answers_sent;
  tests += more.tests;
  clusters_fetched += more.clusters_fetched;
  clusters_fetched_bytes += more.clusters_fetched_bytes;
  clusters_moved += more.clusters_moved;
  clusters_dropped += more.clusters_dropped;
  clusters = more.clusters;
  tree_bytes = more.tree_bytes;
  geometry_bytes = more.geometry_bytes;  // the most since the scene was shared out
  timeline.insert(timeline.end(), more.timeline.begin(), more.timeline.end());
}

void Statistics::operator+=(Statistics&& more) {
  if (ranks.empty() && rays == RayCounts{}) {
    *this = std::move(more);
    return;
  }
  frame_seconds += more.frame_seconds;
  trace_seconds += more.trace_seconds;
  gather_seconds += more.gather_seconds;
  rays += more.rays;
  partition = more.partition;
  structure_bytes = more.structure_bytes;
  std::vector<double> of_ranks;
  for (std::size_t r = 0; r < ranks.size(); ++r) {
    ranks[r] += std::move(more.ranks[r]);
    of_ranks.push_back(static_cast<double>(ranks[r].rays.sent()));
  }
  imbalance_rays = loadbalance::imbalance(of_ranks);
}

int tile_side(const RenderOptions& options) {
  return options.tile > 0 ? options.tile : integrator(options.integrator).side;
}

loadbalance::ScheduleOptions tile_schedule(std::uint32_t tiles, int ranks, int threads) {
  loadbalance::ScheduleOptions how;
  how.threads = threads;
  // A tile of few rays is done sooner than a request is answered by a master at work: several at
  // once then, asked for before the last ones are begun, while there are many for each rank.
  constexpr std::uint32_t kBatches = 32;  // for each rank, at least
  how.batch = std::max(static_cast<std::uint32_t>(threads),
                       tiles / (kBatches * static_cast<std::uint32_t>(ranks)));
  how.ahead = std::max(1U, how.batch / 2);
  return how;
}

struct Renderer::Memory {
  const Tracer* tracer;  // or
  SharedScene* scene;    // with
  const Distribution* distribution;
  TileShares shares = {};
  PlannedTiles planned = {};
  FirstHits::Trials trials = {};
  image::ImageF last = {};  // given back

  image::ImageF picture(const geometry::Rect& window) {
    if (last.width == window.width() && last.height == window.height())
      return std::exchange(last, {});
    return {window.width(), window.height()};
  }
  const shading::Shader& shader() const { return tracer ? tracer->shader : scene->shader(); }
  const LightTable& lights() const { return tracer ? tracer->lights : scene->lights(); }
  geometry::Box3 bounds() const { return tracer ? tracer->embree.bounds() : scene->bounds(); }
};

Renderer::Renderer(const Tracer& tracer) : memory_(new Memory{&tracer, nullptr, nullptr}) {}
Renderer::Renderer(SharedScene& scene, const Distribution& distribution)
    : memory_(new Memory{nullptr, &scene, &distribution}) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Result Renderer::render(comm::Communicator& communicator, const scenes::Camera& camera,
                        const RenderOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  check(options);
  check(camera);
  const std::uint64_t dropped = memory_->scene != nullptr ? memory_->scene->evicted() : 0;
  const Tracer* const tracer = memory_->tracer;
  const int width = std::max(0, options.width), height = std::max(0, options.height);
  scenes::View view;
  if (width > 0 && height > 0) view = scenes::make_view(camera, width, height);
  view.width = width;
  view.height = height;
  const geometry::Rect whole{0, 0, width, height};
  const geometry::Rect window = options.part.window.empty() ? whole : options.part.window;
  const shading::BatchShader shader = shading::make_batch_shader(memory_->shader());
  const FrameContext context{shader,
                             memory_->lights(),
                             view,
                             options.trace,
                             options.samples,
                             options.scattered,
                             scenes::pixels_of(view, memory_->bounds()),
                             options.part.pixels};
  IntegratorPool pool(integrator(options.integrator), context);
  const int side = tile_side(options);
  check_displays(options.displays, window, communicator.size());
  const bool root = communicator.rank() == 0;
  const bool gathers = root && options.displays.empty();
  Result result;
  if (gathers) {
    result.image = memory_->picture(window);
    if (!options.part.squares.empty()) image::clear(result.image);
  }
  const FirstHits::Made first =
      first_hits(communicator, tracer, options, context, window, memory_->trials);
  const TiledFrame frame{tracer,
                         options,
                         context,
                         pool,
                         {window, side, side},
                         gathers ? &result.image : nullptr,
                         first.hits.get()};
  std::vector<comm::Event> events;
  comm::Recording recording(communicator, events);
  Statistics& statistics = result.statistics;
  statistics.why_traced = first.why_not;

  recording.mark(comm::Phase::redistribute, 0);
  loadbalance::ScheduleOptions how =
      tile_schedule(frame.tiles.grid().count(), communicator.size(), parallel::arena_threads());
  how.master_works = options.master_works;
  if (!options.partition.empty()) {
    how.initial = memory_->shares.next(recording, frame.tiles, options);
    if (root) statistics.partition = memory_->shares.statistics();
  }

  recording.mark(comm::Phase::trace, 0);
  Traced traced = tracer != nullptr ? trace(recording, frame, how)
                                    : trace(recording, frame, *memory_->scene,
                                            *memory_->distribution, memory_->planned, how);
  statistics.trace_seconds = seconds_since(start);

  recording.mark(comm::Phase::gather, 0);
  std::vector<TileCost> costs;
  if (options.displays.empty()) {
    costs = collect_tiles(recording, frame.tiles, traced.tiles, result.image);
  } else {
    result.shown = deliver_tiles(recording, traced.tiles, options.displays);
    costs = collect_costs(recording, traced.tiles);
  }
  if (root) memory_->shares.learn(frame.tiles, costs, options.costs);
  result.tile_costs = std::move(costs);
  statistics.frame_seconds = seconds_since(start);
  statistics.gather_seconds = statistics.frame_seconds - statistics.trace_seconds;

  const comm::Totals totals = comm::totals(events, communicator.world_rank(communicator.rank()));
  RankStatistics mine = statistics_of(traced, totals);
  if (tracer != nullptr) {
    add_scene(*tracer, mine, statistics);
  } else {
    add_scene(*memory_->scene, dropped, mine, statistics);
  }
  summarize(gather_statistics(communicator, mine), statistics);
  return result;
}

void Renderer::recycle(image::ImageF&& picture) { memory_->last = std::move(picture); }

Result render(comm::Communicator& communicator, const Tracer& tracer, const scenes::Camera& camera,
              const RenderOptions& options) {
  return Renderer(tracer).render(communicator, camera, options);
}

Result render(comm::Communicator& communicator, const scenes::Scene& scene,
              const scenes::Camera& camera, const RenderOptions& options) {
  const Tracer tracer = make_tracer(scene, options.build);
  return render(communicator, tracer, camera, options);
}

}  // namespace delray::raytrace
