// Cuts the screen by every partition and draws frames with each, then chooses among the results.
//
// Ranks take turns on one thread, so that each is timed as if it had a core of its own, and their
// recorded messages are replayed over each network. Beyond kMostMeasuredRanks the screen is cut
// only, and the costs foretell the balance; strategies are drawn there too, and counted.
// Recommended are partitions that are even by counts and quick by processor time, and of these the
// ones that are cut soonest.
//
// Degenerate: where no partition is both even and quick, the even ones win; a stop keeps what is
// finished.
#include "apps/compare/partition/compare_partition.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <limits>

#include "apps/compare/simulated_frames.h"
#include "apps/compare/verdict.h"
#include "comm/network.h"
#include "composite/layer_costs.h"
#include "image/hash.h"
#include "loadbalance/balance.h"
#include "parallel/arena.h"
#include "raster/strategies.h"

namespace delray::apps {
namespace {

// Frames that follow the first where ranks are not measured, but counted.
constexpr FrameCounts kCounted{4, 3}, kCountedQuickly{3, 2};
// Smaller images tell too little of what layers cost.
constexpr std::uint64_t kFewestPixelsTimed = 1 << 16;
// Turning frames of ranks that are measured.
constexpr int kTurning = 3;

DrawnFrames drawn_of(const SimulatedFrames& frames, std::span<const comm::NamedNetwork> networks,
                     double alone_work, std::string hash) {
  DrawnFrames result;
  const auto bytes = [](const raster::Statistics& s) {
    std::uint64_t sum = 0;
    for (const raster::RankStatistics& rank : s.ranks) sum += rank.bytes_sent;
    return sum;
  };
  const raster::Statistics& first = frames.first.statistics;
  result.bytes_total = bytes(first);
  for (const raster::RankStatistics& rank : first.ranks) {
    result.messages += rank.messages;
    result.triangles_total += rank.triangles;
    result.triangles_max = std::max(result.triangles_max, rank.triangles);
    result.shaded_max = std::max(result.shaded_max, rank.shaded);
    result.work.push_back(raster::cost_model(raster::Lighting::phong)(
        static_cast<double>(rank.triangles), static_cast<double>(rank.shaded)));
  }
  result.work_imbalance = loadbalance::imbalance(result.work);
  if (alone_work > 0) {
    result.work_over_share = *std::max_element(result.work.begin(), result.work.end()) *
                             static_cast<double>(result.work.size()) / alone_work;
  }
  result.bytes_next = bytes(frames.next.front().statistics);
  std::vector<double> busiest, imbalance;
  std::vector<std::vector<double>> by_rank(first.ranks.size());
  for (const raster::SimulatedFrame& frame : frames.next) {
    double most = 0;
    for (std::size_t k = 0; k < by_rank.size(); ++k) {
      by_rank[k].push_back(frame.statistics.ranks[k].busy);
      most = std::max(most, by_rank[k].back());
    }
    busiest.push_back(most);
    imbalance.push_back(frame.statistics.imbalance);
  }
  result.busiest = spread_of(std::move(busiest));
  result.imbalance = spread_of(std::move(imbalance));
  for (std::vector<double>& seconds : by_rank)
    result.busy.push_back(spread_of(std::move(seconds)).median);
  for (const comm::NamedNetwork& named : networks) {
    const Spread next = seconds_over(frames.next, named.network);
    result.predicted.push_back(
        {named.name, next.median, next, seconds_over(frames.first, named.network)});
  }
  result.hash = std::move(hash);
  return result;
}

class PartitionRuns {
 public:
  PartitionRuns(const PartitionRequest& request, const Prepared& prepared,
                parallel::Progress& progress)
      : request_(request),
        prepared_(prepared),
        steps_(progress),
        renderer_(prepared.scene, prepared.shader),
        scaling_(prepared.triangles, request.networks) {
    options_.width = request.render.width;
    options_.height = request.render.height;
  }

  PartitionComparison run() {
    const std::size_t strategies = raster::strategies().size();
    steps_.start(1 + partitions().size() * variants().size() + (strategies - 1) * measured_ranks() +
                 strategies * (request_.ranks.size() - measured_ranks()));
    try {
      draw_alone();
      for (const auto& [ranks, regions] : variants()) {
        spdlog::info("{} ranks, {} region{} each", ranks, regions, regions > 1 ? "s" : "");
        if (request_.render.layout.wall && regions == request_.regions.front())
          result_.walls.push_back(wall_of(ranks));
        for (const loadbalance::Partitioner* partitioner : partitions()) {
          steps_.stop_if_asked();
          compare(*partitioner, ranks, regions);
          steps_.done();
        }
        if (regions != request_.regions.front()) continue;
        if (ranks <= kMostMeasuredRanks)
          compare_strategies(ranks);
        else
          count_strategies(ranks);
      }
    } catch (const parallel::Interrupted&) {
      if (result_.rows.empty()) throw;
      result_.unfinished = true;
    }
    result_.scaling = scaling_.result();
    result_.networks = request_.networks;
    return std::move(result_);
  }

 private:
  int repeats() const { return request_.quick ? 3 : 9; }

  std::vector<const loadbalance::Partitioner*> partitions() const {
    std::vector<const loadbalance::Partitioner*> result;
    for (const loadbalance::Partitioner& partitioner : loadbalance::partitioners()) {
      if (request_.partitions.empty() ||
          std::find(request_.partitions.begin(), request_.partitions.end(), partitioner.name) !=
              request_.partitions.end())
        result.push_back(&partitioner);
    }
    return result;
  }

  // Numbers of ranks and of regions for each.
  std::vector<std::pair<int, int>> variants() const {
    std::vector<std::pair<int, int>> result;
    for (const int ranks : request_.ranks) {
      for (const int regions : request_.regions) {
        if (regions == request_.regions.front() || ranks == shown_ranks(request_))
          result.emplace_back(ranks, regions);
      }
    }
    return result;
  }
  std::size_t measured_ranks() const {
    return static_cast<std::size_t>(
        std::count_if(request_.ranks.begin(), request_.ranks.end(),
                      [](int ranks) { return ranks <= kMostMeasuredRanks; }));
  }

  raster::RenderOptions options_of(const std::string& strategy, const char* partition,
                                   int regions) const {
    raster::RenderOptions options = options_;
    options.strategy = strategy;
    options.partition = partition;
    options.regions_per_rank = regions;
    options.codec = "active";
    // Batches that come by chance would be recorded as if they always came so.
    options.redistribution = raster::Redistribution::at_end;
    return options;
  }
  SimulatedFrames draw(const std::string& strategy, const char* partition, int ranks, int regions,
                       bool turns = true) {
    return simulate_frames(prepared_, options_of(strategy, partition, regions), ranks,
                           {repeats(), turns ? kTurning : 0}, steps_.inside());
  }

  // As `delray render` would tell it.
  std::string hash_of(image::Image8& picture) const {
    put_behind(picture, prepared_.background, prepared_.shading(),
               scenes::make_view(prepared_.camera, request_.render.width, request_.render.height));
    return image::hash(picture);
  }

  void draw_alone() {
    SimulatedFrames frames = draw("sort-first", loadbalance::partitioners()[0].name, 1, 1);
    scaling_.alone(frames);
    const DrawnFrames alone = drawn_of(frames, request_.networks, 0, {});
    result_.alone_seconds = alone.busiest.median;
    result_.alone = alone.busiest;
    result_.alone_work = alone.work[0];
    hash_of(frames.picture);
    result_.picture = std::move(frames.picture);
    steps_.done();
  }

  const loadbalance::Costs& costs(int regions) {
    if (costs_of_ != regions) {
      costs_ = parallel::Arena(parallel::arena_threads()).execute([&] {
        return renderer_.costs(regions, prepared_.camera, options_);
      });
    }
    costs_of_ = regions;
    return costs_;
  }

  ComparedWall wall_of(int ranks) {
    const loadbalance::Wall& wall = *request_.render.layout.wall;
    const std::vector<loadbalance::Region> displays = loadbalance::displays_of(wall, ranks);
    ComparedWall row;
    row.ranks = ranks;
    std::vector<loadbalance::Region> gathered = displays;
    for (loadbalance::Region& display : gathered) display.owner = 0;
    const loadbalance::Partition at_home = loadbalance::cut_by_displays(wall.frame(), displays);
    row.gathered = loadbalance::pixel_traffic(at_home, gathered, ranks).busiest;
    const loadbalance::Balance balance =
        loadbalance::balance(at_home, costs(ranks * request_.regions.front()).boxes, ranks);
    row.predicted_over_share = balance.over_share;
    row.overlap = balance.overlap;
    return row;
  }

  void compare(const loadbalance::Partitioner& partitioner, int ranks, int regions) {
    const loadbalance::Costs& costs = this->costs(ranks * regions);
    ComparedPartition row;
    row.partition = partitioner.name;
    row.ranks = ranks;
    row.regions_per_rank = regions;
    std::vector<double> seconds;
    for (int repeat = 0; repeat < repeats(); ++repeat) {
      const loadbalance::PartitionReport report =
          loadbalance::report(partitioner, costs, ranks, regions);
      seconds.push_back(report.seconds);
      row.regions = report.partition.regions.size();
      row.primitives = report.balance.primitives;
      row.shared = report.balance.shared;
      row.overlap = report.balance.overlap;
      row.predicted_imbalance = report.balance.imbalance;
      row.predicted_over_share = report.balance.over_share;
      if (const auto& wall = request_.render.layout.wall) {
        row.to_displays = loadbalance::pixel_traffic(report.partition,
                                                     loadbalance::displays_of(*wall, ranks), ranks);
      }
    }
    row.cut_seconds = spread_of(std::move(seconds));
    if (ranks <= kMostMeasuredRanks) {
      const bool is_of_strategies =
          &partitioner == partitions().front() && regions == request_.regions.front();
      SimulatedFrames frames =
          draw("sort-first", partitioner.name, ranks, regions, is_of_strategies);
      if (is_of_strategies) scaling_.timed("sort-first", ranks, frames);
      row.drawn = drawn_of(frames, request_.networks, result_.alone_work, hash_of(frames.picture));
      row.finish_seconds =
          row.cut_seconds.median + row.drawn->work_over_share * result_.alone_seconds / ranks;
      const auto& cut = frames.first.statistics.partition;
      if (cut) {  // by the costs that the ranks summed, as `delray render` tells it
        row.primitives = cut->primitives;
        row.shared = cut->shared;
        row.overlap = cut->overlap;
        row.predicted_imbalance = loadbalance::imbalance(cut->loads);
        row.predicted_over_share = cut->over_share;
      }
      if (cut && ranks == shown_ranks(request_) && regions == request_.regions.front()) {
        result_.shown.push_back(
            {row.partition, cut->partition, cut->loads, row.drawn->work, row.drawn->busy});
      }
    }
    result_.rows.push_back(std::move(row));
  }

  void compare_strategies(int ranks) {
    const char* const partition = partitions().front()->name;
    for (const raster::Strategy& strategy : raster::strategies()) {
      steps_.stop_if_asked();
      if (std::string_view(strategy.name) == "sort-first") {
        const auto row = std::find_if(result_.rows.begin(), result_.rows.end(),
                                      [&](const ComparedPartition& one) {
                                        return one.ranks == ranks && one.partition == partition &&
                                               one.regions_per_rank == request_.regions.front();
                                      });
        result_.strategies.push_back({strategy.name, ranks, *row->drawn});
        continue;
      }
      SimulatedFrames frames = draw(strategy.name, partition, ranks, 1);
      scaling_.timed(strategy.name, ranks, frames);
      result_.strategies.push_back(
          {strategy.name, ranks,
           drawn_of(frames, request_.networks, result_.alone_work, hash_of(frames.picture))});
      steps_.done();
    }
  }

  // More ranks than are measured: their drawing is counted, and images are not kept.
  void count_strategies(int ranks) {
    for (const raster::Strategy& strategy : raster::strategies()) {
      steps_.stop_if_asked();
      if (!scaling_.fits(strategy.name, ranks)) {
        steps_.done();
        continue;
      }
      spdlog::info("{} ranks, {}", ranks, strategy.name);
      raster::RenderOptions options = options_of(
          strategy.name, partitions().front()->name,
          std::string_view(strategy.name) == "sort-first" ? request_.regions.front() : 1);
      if (strategy.composites) options.count_only = layer_costs();
      scaling_.counted(
          strategy.name, ranks,
          simulate_frames(prepared_, options, ranks, request_.quick ? kCountedQuickly : kCounted,
                          steps_.inside()));
      steps_.done();
    }
  }

  const composite::LayerCosts& layer_costs() {
    if (!layer_costs_) {
      const auto pixels =
          static_cast<std::uint64_t>(options_.width) * static_cast<std::uint64_t>(options_.height);
      layer_costs_ = composite::measure_layer_costs(*composite::find_codec("active"),
                                                    std::max(pixels, kFewestPixelsTimed));
    }
    return *layer_costs_;
  }

  const PartitionRequest& request_;
  const Prepared& prepared_;
  Steps steps_;
  raster::Renderer renderer_;
  raster::RenderOptions options_;
  int costs_of_ = 0;
  loadbalance::Costs costs_;
  ScalingRuns scaling_;
  std::optional<composite::LayerCosts> layer_costs_;
  PartitionComparison result_;
};

}  // namespace

int shown_ranks(const PartitionRequest& request) {
  return shown_ranks_of(request.ranks, kMostShownRanks);
}

PartitionComparison compare_partition(const PartitionRequest& request, const Prepared& prepared,
                                      parallel::Progress& progress) {
  return PartitionRuns(request, prepared, progress).run();
}

double over_share(const ComparedPartition& row) {
  return row.drawn ? row.drawn->work_over_share : row.predicted_over_share;
}

bool takes_longer(const Spread& seconds, const Spread& least) {
  return seconds.median > least.median * kAsEven && differ(seconds, least);
}

PartitionChoice choose_partition(const std::vector<ComparedPartition>& rows, int ranks) {
  using Rows = std::vector<const ComparedPartition*>;
  Rows all, drawn;
  double least = std::numeric_limits<double>::infinity();
  for (const ComparedPartition& row : rows) {
    if (row.ranks != ranks || row.regions_per_rank != rows.front().regions_per_rank) continue;
    all.push_back(&row);
    if (row.drawn) drawn.push_back(&row);
    least = std::min(least, over_share(row));
  }
  PartitionChoice choice;
  std::copy_if(all.begin(), all.end(), std::back_inserter(choice.even),
               [&](const ComparedPartition* row) { return over_share(*row) <= least * kAsEven; });
  std::stable_sort(drawn.begin(), drawn.end(), [](const auto* a, const auto* b) {
    return a->drawn->busiest.median < b->drawn->busiest.median;
  });
  for (const ComparedPartition* row : drawn) {
    if (!takes_longer(row->drawn->busiest, drawn.front()->drawn->busiest))
      choice.quick.push_back(row);
  }
  Rows both;
  std::copy_if(choice.even.begin(), choice.even.end(), std::back_inserter(both),
               [&](const ComparedPartition* row) {
                 return std::find(choice.quick.begin(), choice.quick.end(), row) !=
                        choice.quick.end();
               });
  choice.agree = drawn.empty() || !both.empty();
  choice.best =
      winners<ComparedPartition>(both.empty() ? choice.even : both,
                                 [](const ComparedPartition& row) { return row.cut_seconds; });
  return choice;
}

}  // namespace delray::apps
