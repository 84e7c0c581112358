// Measures every tile of a picture once, then lets every schedule hand out the tiles on a simulated
// machine.
//
// One rank with one thread traces whole frames, which gives each tile's processor time and rays.
// Schedules run their own code over simulated networks on the medians of these times, and on single
// frames for the spread. Up to as many ranks as there are cores, two at least, also trace whole
// frames.
//
// Degenerate: a stop keeps what is finished.
#include "apps/compare/schedule/compare_schedule.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <numeric>
#include <thread>

#include "apps/compare/schedule/cut_levels.h"
#include "apps/compare/verdict.h"
#include "comm/collectives.h"
#include "image/hash.h"
#include "image/srgb.h"
#include "loadbalance/partition.h"
#include "loadbalance/simulated_schedule.h"
#include "loadbalance/task_grid.h"
#include "parallel/arena.h"
#include "parallel/processor_time.h"

namespace delray::apps {
namespace {

// Single frames that are handed out beside the medians of their tiles, for the spread.
constexpr std::size_t kSampleFrames = 3;
// Frames of a scene that is shared out: the last of them finds caches as the others left them.
constexpr int kDistributedFrames = 2;

ScheduleOver summary_of(const std::string& network, const loadbalance::SimulatedSchedule& run) {
  ScheduleOver result;
  result.network = network;
  result.seconds = run.seconds;
  for (const loadbalance::RankReport& rank : run.ranks) {
    result.requests += rank.requests;
    result.steals += rank.steals;
    result.tasks_stolen += rank.tasks_stolen;
    result.rays_stolen += rank.units_stolen;
    result.messages += rank.messages;
    result.bytes += rank.bytes_sent;
  }
  result.ray_imbalance = loadbalance::imbalance(run.rays);
  result.time_imbalance = loadbalance::imbalance(run.busy);
  const double all = run.seconds * static_cast<double>(run.ranks.size());
  if (all > 0) result.idle = 1 - std::accumulate(run.busy.begin(), run.busy.end(), 0.0) / all;
  return result;
}

// Where the time of the rank that traces longest goes.
void split(const loadbalance::SimulatedSchedule& run, ScheduleOver& over) {
  over.frame_seconds = run.frame_seconds;
  for (const loadbalance::RankReport& rank : run.ranks) {
    double traced = 0, served = 0;
    for (const loadbalance::Interval& interval : rank.timeline) {
      const double seconds = interval.end - interval.begin;
      if (interval.kind == loadbalance::Interval::Kind::work) traced += seconds;
      if (interval.kind == loadbalance::Interval::Kind::serve) served += seconds;
    }
    if (&rank != run.ranks.data() && traced <= over.parts[0]) continue;
    over.parts = {traced, served, rank.end - traced - served, run.frame_seconds - rank.end};
  }
}

// Seconds that a byte takes to be copied to memory that is not in the cache.
double copy_seconds_per_byte() {
  constexpr std::size_t kBytes = std::size_t{1} << 25;
  constexpr int kTimes = 5;
  const std::vector<std::byte> from(kBytes, std::byte{1});
  std::vector<std::byte> to(kBytes);
  std::vector<double> seconds;
  for (int i = 0; i < kTimes; ++i) {
    const std::int64_t begin = parallel::processor_nanoseconds();
    std::copy(from.begin(), from.end(), to.begin());
    seconds.push_back(static_cast<double>(parallel::processor_nanoseconds() - begin) * 1e-9);
  }
  return spread_of(std::move(seconds)).median / static_cast<double>(kBytes);
}

class ScheduleRuns {
 public:
  ScheduleRuns(const Session& session, const ScheduleRequest& request, const Prepared& prepared,
               parallel::Progress& progress)
      : session_(session), request_(request), prepared_(prepared), steps_(progress) {
    options_.width = request.render.width;
    options_.height = request.render.height;
    options_.samples = request.render.raytrace.samples;
    options_.trace.depth = request.render.raytrace.trace.depth;
    options_.trace.background = raytrace::TraceOptions::Background::transparent;
    options_.integrator = request.render.raytrace.integrator;
    options_.tile = request.tile;
    options_.progress = steps_.inside();
    blocks_ = {{0, 0, options_.width, options_.height}, request.tile, request.tile};
  }

  ScheduleComparison run() {
    const std::size_t count = schedules().size();
    const auto traced = static_cast<std::size_t>(std::count_if(
        request_.ranks.begin(), request_.ranks.end(), [&](int ranks) { return is_traced(ranks); }));
    const auto frames = static_cast<std::size_t>(repeats());
    steps_.start(frames + count * request_.ranks.size() + count * traced * frames +
                 distributions().size() * distributed_ranks().size() + request_.cut_levels.size());
    try {
      measure_tiles();
      for (const int ranks : request_.ranks) {
        spdlog::info("{} ranks", ranks);
        for (const loadbalance::Schedule* schedule : schedules()) {
          steps_.stop_if_asked();
          simulate(*schedule, ranks);
          steps_.done();
        }
      }
      for (ComparedSchedule& row : result_.rows)
        if (is_traced(row.ranks)) trace(row);
      for (const int ranks : distributed_ranks()) distribute(ranks);
      for (const int level : request_.cut_levels) cut(level);
    } catch (const parallel::Interrupted&) {
      if (result_.rows.empty()) throw;
      result_.unfinished = true;
    }
    return std::move(result_);
  }

 private:
  int repeats() const { return request_.quick ? 3 : 7; }
  // More ranks than cores would tell what the system does with them.
  static bool is_traced(int ranks) {
    return ranks <= static_cast<int>(std::max(2U, std::thread::hardware_concurrency()));
  }

  std::vector<const loadbalance::Schedule*> schedules() const {
    std::vector<const loadbalance::Schedule*> result;
    for (const loadbalance::Schedule& schedule : loadbalance::schedules()) {
      if (request_.schedules.empty() ||
          std::find(request_.schedules.begin(), request_.schedules.end(), schedule.name) !=
              request_.schedules.end())
        result.push_back(&schedule);
    }
    return result;
  }

  // But for those that leave the whole scene on every rank.
  std::vector<const raytrace::Distribution*> distributions() const {
    std::vector<const raytrace::Distribution*> result;
    for (const raytrace::Distribution& distribution : raytrace::distributions()) {
      const std::vector<std::string>& names = request_.distributions;
      const bool wanted =
          names.empty() ? !request_.quick
                        : std::find(names.begin(), names.end(), distribution.name) != names.end();
      if (!distribution.replicated && wanted) result.push_back(&distribution);
    }
    return result;
  }
  std::vector<int> distributed_ranks() const {
    std::vector<int> result;
    std::copy_if(request_.ranks.begin(), request_.ranks.end(), std::back_inserter(result),
                 [](int ranks) { return ranks > 1 && ranks <= kMostDistributedRanks; });
    return result;
  }

  // The request's first.
  std::vector<const comm::NamedNetwork*> networks() const {
    std::vector<const comm::NamedNetwork*> result;
    for (const comm::NamedNetwork& named : request_.networks) result.push_back(&named);
    return result;
  }

  image::Image8 finished(image::ImageF&& picture) const {
    put_behind(picture, prepared_.background, prepared_.shading(),
               scenes::make_view(prepared_.camera, options_.width, options_.height));
    return image::to_8bit(picture);
  }

  // One rank with one thread, so that nobody shares its core.
  void measure_tiles() {
    std::vector<std::vector<double>> seconds(blocks_.grid().count());
    result_.tiles.resize(seconds.size());
    Launch launch;
    launch.ranks = launch.threads = 1;
    for (int repeat = 0; repeat < repeats(); ++repeat) {
      run_ranks(session_, launch, {}, [&](comm::Communicator& communicator) {
        raytrace::Result frame =
            raytrace::render(communicator, *prepared_.tracer, prepared_.camera, options_);
        for (const raytrace::TileCost& tile : frame.tile_costs) {
          seconds[tile.tile].push_back(tile.seconds);
          result_.tiles[tile.tile].rays = tile.rays;
        }
        if (repeat == 0) result_.picture = finished(std::move(frame.image));
      });
      steps_.done();
    }
    sample_frames(seconds);
    for (std::size_t i = 0; i < seconds.size(); ++i) {
      Tile& tile = result_.tiles[i];
      tile.pixels = blocks_.block(static_cast<std::uint32_t>(i));
      tile.seconds = spread_of(std::move(seconds[i]));
      bytes_.push_back(sizeof(raytrace::TileCost) + static_cast<std::uint64_t>(tile.pixels.area()) *
                                                        (sizeof(image::RgbaF) + sizeof(float)));
      seconds_.push_back(tile.seconds.median);
      rays_.push_back(tile.rays);
      result_.rays += tile.rays;
      result_.seconds += tile.seconds.median;
    }
    scale_samples();
  }

  // Keeps what the tiles took in frames from the fastest to the slowest, evenly chosen, and how
  // long all frames took. `seconds` are of tile i in each frame.
  void sample_frames(const std::vector<std::vector<double>>& seconds) {
    const std::size_t frames = seconds.front().size();
    std::vector<double> totals(frames);
    for (const std::vector<double>& tile : seconds)
      for (std::size_t f = 0; f < frames; ++f) totals[f] += tile[f];
    result_.frame = spread_of(totals);
    std::vector<std::size_t> order(frames);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return totals[a] < totals[b]; });
    const std::size_t count = std::min(kSampleFrames, frames);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t f = order[count > 1 ? k * (frames - 1) / (count - 1) : 0];
      std::vector<double>& sample = samples_.emplace_back();
      for (const std::vector<double>& tile : seconds) sample.push_back(tile[f]);
    }
  }

  // Scales each sample so that all its tiles together take as long as their medians.
  void scale_samples() {
    for (std::vector<double>& sample : samples_) {
      const double total = std::accumulate(sample.begin(), sample.end(), 0.0);
      if (total > 0)
        for (double& tile : sample) tile *= result_.seconds / total;
    }
  }

  // A ray that goes to another rank is followed there by the others of its sample.
  double samples_per_ray() const {
    const double samples = static_cast<double>(options_.width) * options_.height * options_.samples;
    return samples / static_cast<double>(std::max<std::uint64_t>(1, result_.rays));
  }

  loadbalance::SimulatedSchedule simulated(const loadbalance::Schedule& schedule, int ranks,
                                           const comm::NamedNetwork& named,
                                           const std::vector<double>& seconds) const {
    const loadbalance::SimulatedTasks tasks{blocks_.grid(),
                                            seconds,
                                            bytes_,
                                            sizeof(std::uint64_t),
                                            copy_seconds_,
                                            rays_,
                                            samples_per_ray() * raytrace::kMovedRayBytes,
                                            samples_per_ray() * raytrace::kMovedResultBytes,
                                            rays_};
    return loadbalance::simulate(schedule, tasks, ranks, named.network,
                                 raytrace::tile_schedule(blocks_.grid().count(), ranks, 1));
  }

  void simulate(const loadbalance::Schedule& schedule, int ranks) {
    ComparedSchedule row{schedule.name, ranks, {}, {}};
    for (const comm::NamedNetwork* named : networks()) {
      loadbalance::SimulatedSchedule run = simulated(schedule, ranks, *named, seconds_);
      ScheduleOver over = summary_of(named->name, run);
      std::vector<double> times = {over.seconds};
      for (const std::vector<double>& sample : samples_)
        times.push_back(simulated(schedule, ranks, *named, sample).seconds);
      over.spread = spread_of(std::move(times));
      over.spread.median = over.seconds;
      split(run, over);
      row.over.push_back(std::move(over));
      if (row.over.size() == 1 && ranks == shown_ranks(request_))
        result_.shown.push_back({schedule.name, std::move(run.owners), std::move(run.ranks)});
    }
    result_.rows.push_back(std::move(row));
  }

  void trace(ComparedSchedule& row) {
    Launch launch;
    launch.ranks = row.ranks;
    launch.threads = 1;
    raytrace::RenderOptions options = options_;
    options.schedule = row.schedule;
    TracedFrames traced;
    std::vector<double> seconds;
    for (int repeat = 0; repeat < repeats(); ++repeat) {
      steps_.stop_if_asked();
      run_ranks(session_, launch, {}, [&](comm::Communicator& communicator) {
        comm::barrier(communicator);
        const double begin = communicator.seconds();
        raytrace::Result frame =
            raytrace::render(communicator, *prepared_.tracer, prepared_.camera, options);
        if (communicator.rank() != 0) return;
        seconds.push_back(communicator.seconds() - begin);
        if (repeat > 0) return;
        traced.ray_imbalance = frame.statistics.imbalance_rays;
        for (const raytrace::RankStatistics& rank : frame.statistics.ranks) {
          traced.requests += rank.requests;
          traced.steals += rank.steals;
          traced.rays_stolen += rank.rays_stolen;
          traced.messages += rank.messages;
        }
        traced.hash = image::hash(finished(std::move(frame.image)));
      });
      steps_.done();
    }
    traced.seconds = spread_of(std::move(seconds));
    row.traced = std::move(traced);
  }

  // Runs the renderer's own code over each network: what rays meet depends on what comes first.
  void distribute(int ranks) {
    for (const raytrace::Distribution* distribution : distributions()) {
      ComparedDistribution row{distribution->name, ranks, {}};
      spdlog::info("{} ranks, {}", ranks, distribution->name);
      for (const comm::NamedNetwork* named : networks()) {
        steps_.stop_if_asked();
        if (named->network.is_bus()) continue;
        const std::vector<raytrace::SimulatedFrame> frames = raytrace::simulate_frames(
            {prepared_.scene, *prepared_.tracer, prepared_.camera, options_, kDistributedFrames},
            *distribution, ranks, named->network);
        row.over.push_back({named->name, frames.back()});
      }
      result_.distributions.push_back(std::move(row));
      steps_.done();
    }
  }

  // Over the first network that not all ranks share.
  void cut(int level) {
    steps_.stop_if_asked();
    const std::vector<const comm::NamedNetwork*> all = networks();
    const auto named =
        std::ranges::find_if(all, [](const auto* n) { return !n->network.is_bus(); });
    const std::vector<int> ranks = distributed_ranks();
    if (named != all.end() && !ranks.empty()) {
      raytrace::ShareOptions share;
      share.cut_level = level;
      const int most = *std::ranges::max_element(ranks);
      const std::vector<raytrace::SimulatedFrame> frames = raytrace::simulate_frames(
          {prepared_.scene, *prepared_.tracer, prepared_.camera, options_, kDistributedFrames,
           share},
          *raytrace::find_distribution(kCutDistribution), most, (*named)->network);
      result_.cut_levels.push_back({level, most, (*named)->name, frames.back()});
    }
    steps_.done();
  }

  const Session& session_;
  const ScheduleRequest& request_;
  const Prepared& prepared_;
  Steps steps_;
  raytrace::RenderOptions options_;
  loadbalance::Blocks blocks_;
  std::vector<double> seconds_;       // of tiles
  std::vector<std::uint64_t> rays_;   // of tiles
  std::vector<std::uint64_t> bytes_;  // of tiles' pixels on the way to rank 0
  const double copy_seconds_ = copy_seconds_per_byte();
  std::vector<std::vector<double>> samples_;  // of tiles in single frames
  ScheduleComparison result_;
};

}  // namespace

int shown_ranks(const ScheduleRequest& request) {
  return shown_ranks_of(request.ranks, kMostShownRanks);
}

ScheduleComparison compare_schedule(const Session& session, const ScheduleRequest& request,
                                    const Prepared& prepared, parallel::Progress& progress) {
  return ScheduleRuns(session, request, prepared, progress).run();
}

std::vector<const ComparedSchedule*> best_schedules(const std::vector<ComparedSchedule>& rows,
                                                    int ranks, std::size_t network) {
  std::vector<const ComparedSchedule*> all;
  for (const ComparedSchedule& row : rows)
    if (row.ranks == ranks) all.push_back(&row);
  return winners<ComparedSchedule>(
      all, [&](const ComparedSchedule& row) { return row.over[network].spread; });
}

ScalingLimit limit_of(const ScheduleComparison& comparison, const std::string& schedule,
                      std::size_t network) {
  std::vector<ScaledFrame> frames;
  for (const ComparedSchedule& row : comparison.rows) {
    if (row.schedule != schedule) continue;
    const ScheduleOver& over = row.over[network];
    frames.push_back({row.ranks, over.frame_seconds, {over.parts.begin(), over.parts.end()}});
  }
  return limit_of(frames, comparison.seconds);
}

ScalingLimit limit_of_distribution(const ScheduleComparison& comparison,
                                   const std::string& distribution, std::size_t network) {
  std::vector<ScaledFrame> frames;
  for (const ComparedDistribution& row : comparison.distributions) {
    if (row.distribution != distribution) continue;
    const raytrace::SimulatedFrame& frame = row.over[network].frame;
    frames.push_back({row.ranks, frame.seconds, {frame.parts.begin(), frame.parts.end()}});
  }
  return limit_of(frames, comparison.seconds);
}

std::vector<const ComparedSchedule*> best_traced(const std::vector<ComparedSchedule>& rows,
                                                 int ranks) {
  std::vector<const ComparedSchedule*> traced;
  for (const ComparedSchedule& row : rows)
    if (row.ranks == ranks && row.traced) traced.push_back(&row);
  return winners<ComparedSchedule>(traced,
                                   [](const ComparedSchedule& row) { return row.traced->seconds; });
}

}  // namespace delray::apps
