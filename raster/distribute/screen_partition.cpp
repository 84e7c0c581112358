// Cuts the screen by the costs of groups of primitives, and keeps a partition for as long as it
// does.
//
// A group's cost is a price for its triangles and one for the part of its samples that is expected
// to be seen (coverage.cpp); large triangles add theirs to the grid, square by square. Where costs
// are measured, prices are fitted to what ranks did in the last frame and regions are scaled to
// what they took. O(triangles) to bound, by vectors and in parallel.
//
// Degenerate: where camera and options are those of the last frame for all ranks, its groups and
// cuts serve again: nothing is bounded, and nothing but the agreement travels.
#include "raster/distribute/screen_partition.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <mutex>
#include <tuple>

#include "comm/collectives.h"
#include "loadbalance/balance.h"
#include "loadbalance/costs.h"
#include "loadbalance/wall.h"
#include "parallel/parallel_for.h"
#include "raster/distribute/coverage.h"
#include "raster/distribute/extent.h"
#include "raster/distribute/rank_context.h"
#include "raster/pipeline/processor_seconds.h"
#include "raster/pipeline/samples.h"

namespace delray::raster {
namespace {

// The price of a pixel that is drawn, where one that is seen, and shaded, costs 1.
constexpr double kDrawnPixelPrice = 0.05;

// On a grid fine enough for so many regions.
loadbalance::Costs costs_of(const geometry::Rect& frame, int regions,
                            std::vector<loadbalance::WeightedBox> boxes) {
  const int side = loadbalance::cost_cell_side(frame, regions);
  return loadbalance::make_costs(frame, (frame.width() + side - 1) / side,
                                 (frame.height() + side - 1) / side, std::move(boxes));
}

}  // namespace

loadbalance::RasterCostModel cost_model(Lighting lighting) {
  return lighting == Lighting::gouraud ? loadbalance::RasterCostModel{3, 1}
                                       : loadbalance::RasterCostModel{2, 1};
}

std::vector<Piece> groups_of(std::span<const Piece> pieces, std::uint32_t triangles) {
  std::vector<Piece> groups;
  for (const Piece& piece : pieces) {
    const std::uint32_t end = piece.first + piece.count;
    for (std::uint32_t first = piece.first, next; first < end; first = next) {
      next = first + triangles;
      // Full clusters stay whole.
      if (triangles >= kClusterTriangles) next -= next % kClusterTriangles;
      next = std::min(next, end);
      groups.push_back({piece.mesh, piece.transform, first, next - first,
                        piece.primitive + (first - piece.first), piece.clusters});
    }
  }
  return groups;
}

std::uint32_t ScreenPartition::group_triangles(std::uint64_t triangles, int parts) {
  return static_cast<std::uint32_t>(loadbalance::primitives_per_box(triangles, parts));
}

bool ScreenPartition::CostInputs::operator==(const CostInputs& other) const {
  const auto fields = [](const CostInputs& b) {
    const scenes::View& v = b.view;
    return std::tie(b.rank, b.ranks, b.supersampling, b.lighting, b.costs, b.cull_single_sided,
                    b.with_visible, v.eye, v.right, v.up, v.forward, v.scale, v.half_width,
                    v.half_height, v.near, v.width, v.height, v.orthographic, v.far, v.viewpoint);
  };
  return fields(*this) == fields(other);
}

// Prices, fitted to what all ranks did in the last frame where costs are measured. Collective then.
loadbalance::RasterCostModel ScreenPartition::model_of(RankContext& rank) {
  const loadbalance::RasterCostModel model = cost_model(rank.options.lighting);
  samples_.clear();
  if (rank.options.costs != CostSource::measured || rank.ranks() == 1) return model;
  for (const comm::Buffer& from :
       comm::all_gather(rank.communicator, comm::Buffer::of_value(sample_)))
    samples_.push_back(from.as<loadbalance::RasterSample>()[0]);
  return loadbalance::has_seconds(samples_) ? loadbalance::fit(samples_) : model;
}

// The groups stay as long as the rank's share of the scene does, wherever the camera goes.
void ScreenPartition::group(RankContext& rank, const Grouping& grouping) {
  if (grouping_ == grouping) return;
  grouping_ = grouping;
  std::vector<Piece>& groups = costed_.groups;
  groups = groups_of(
      pieces_of(rank.prepared.scene, rank.prepared.first_primitives, grouping.begin, grouping.end),
      grouping.triangles);
  list_ = make_draw_list(groups, &rank.prepared.clusters);
  // Draws are numbered in the order in which groups first name them.
  draw_of_.resize(groups.size());
  std::uint32_t draw = 0;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (i > 0 && groups[i].transform != groups[i - 1].transform) ++draw;
    draw_of_[i] = draw;
  }
}

// Boxes, and costs of triangles; samples go into the coverage.
ScreenPartition::GroupBounds ScreenPartition::bound(RankContext& rank,
                                                    const loadbalance::RasterCostModel& model,
                                                    Coverage& coverage) {
  const std::vector<Piece>& groups = costed_.groups;
  std::vector<loadbalance::WeightedBox>& boxes = costed_.boxes;
  boxes.assign(groups.size(), {});
  GroupBounds bounds{std::vector<double>(groups.size()), std::vector<double>(groups.size()),
                     std::vector<Coverage::Surface>(groups.size())};
  const std::vector<PreparedDraw> draws =
      prepare_draws(rank.screen, list_, rank.prepared.shader(), rank.options.cull_single_sided);
  std::vector<Coverage::Surface> of_draw;
  for (const PreparedDraw& prepared : draws)
    of_draw.push_back(
        {prepared.blended, mean_opacity(rank.prepared.shader(), *prepared.draw->mesh)});
  // Triangles: what Extents looks at for a part of them serves the others.
  constexpr std::size_t kGrain = Extents::kMeasured * kClusterTriangles;
  const std::size_t grain = groups.empty() ? 1 : std::max<std::size_t>(1, kGrain / groups[0].count);
  std::mutex adds_large;
  ProcessorSeconds seconds;
  parallel::parallel_blocks(0, groups.size(), grain, [&](std::size_t begin, std::size_t end) {
    Extents extents(rank.screen);
    std::vector<ScreenTriangle> large;
    seconds.measure([&] {
      for (std::size_t i = begin; i < end; ++i) {
        bounds.surfaces[i] = of_draw[draw_of_[i]];
        large.clear();
        const Extent e = extents.of(draws[draw_of_[i]], groups[i].first, groups[i].count, large);
        if (e.triangles == 0) continue;
        boxes[i].box = pixels_of(e.box, rank.options.supersampling);
        // A border crosses about the root of a patch's triangles.
        boxes[i].cost = model.setup(static_cast<double>(e.triangles));
        boxes[i].setup = model.setup(std::sqrt(static_cast<double>(e.triangles)));
        boxes[i].primitives = e.triangles;
        bounds.samples[i] = static_cast<double>(e.pixels);
        if (large.empty()) continue;
        const std::lock_guard lock(adds_large);
        for (const ScreenTriangle& triangle : large)
          bounds.large_samples[i] += coverage.add_large(triangle, bounds.surfaces[i]);
      }
    });
  });
  for (std::size_t i = 0; i < groups.size(); ++i)
    coverage.add(boxes[i].box, bounds.samples[i], bounds.surfaces[i]);
  rank.counts.phases.bin += seconds.seconds();
  return bounds;
}

// Adds the cost of the samples that are expected to be seen, by the coverage of all ranks.
void ScreenPartition::add_seen(const loadbalance::RasterCostModel& model, const Coverage& coverage,
                               const GroupBounds& bounds, bool with_visible) {
  std::vector<loadbalance::WeightedBox>& boxes = costed_.boxes;
  costed_.seen = {};
  if (with_visible) {
    costed_.seen = {model.per_pixel, std::vector<double>(boxes.size()),
                    std::vector<double>(boxes.size())};
  }
  std::vector<Coverage::Layers> layers[2];  // of opaque and of blended surfaces
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (boxes[i].box.empty()) continue;
    const bool blended = bounds.surfaces[i].blended;
    if (layers[blended].empty()) layers[blended] = coverage.layers(blended);
    const double seen = coverage.seen(boxes[i].box, layers[blended]);
    boxes[i].cost += model.per_pixel * bounds.samples[i] * (seen + kDrawnPixelPrice);
    if (!with_visible) continue;
    costed_.seen.all[i] = seen * (bounds.samples[i] + bounds.large_samples[i]);
    costed_.seen.large[i] = seen * bounds.large_samples[i];
  }
}

const CostedGroups& ScreenPartition::groups(RankContext& rank, const Grouping& grouping,
                                            bool with_visible) {
  const CostInputs inputs{rank.number(),
                          rank.ranks(),
                          rank.screen.view,
                          rank.options.supersampling,
                          rank.options.lighting,
                          rank.options.costs,
                          rank.options.cull_single_sided,
                          with_visible};
  unchanged_ =
      rank.options.costs == CostSource::model && last_inputs_ == inputs && grouping_ == grouping;
  if (rank.ranks() > 1) unchanged_ = agreement_.holds(rank.communicator, unchanged_);
  if (unchanged_) return costed_;
  ++version_;
  cut_before_ = reported_ = false;
  statistics_.reset();
  last_inputs_ = inputs;
  const loadbalance::RasterCostModel model = model_of(rank);
  group(rank, grouping);
  Coverage coverage(rank.screen, rank.options.supersampling);
  const GroupBounds bounds = bound(rank, model, coverage);
  if (rank.ranks() > 1) coverage.sum_over_ranks(rank.communicator);
  add_seen(model, coverage, bounds, with_visible);
  large_.clear();
  if (rank.number() == 0)
    large_ = coverage.costs_of_large(model.per_pixel, model.per_pixel * kDrawnPixelPrice);
  return costed_;
}

const loadbalance::Partition& ScreenPartition::cut(RankContext& rank, int parts, int first_rank) {
  const RenderOptions& options = rank.options;
  Kind kind{options.partition,        rank.ranks(),        parts,
            options.regions_per_rank, options.keep_factor, {}};
  if (options.owners_draw) kind.displays = options.displays;
  if (unchanged_ && cut_before_ && kind == kind_ && (reported_ || !options.report_partition)) {
    if (!options.report_partition) {
      statistics_.reset();
      reported_ = false;
    } else if (statistics_) {
      statistics_->kept = true;
      statistics_->seconds = 0;
    }
    return options.owners_draw ? by_displays_ : kept_->again();
  }
  ++version_;
  cut_before_ = true;
  reported_ = options.report_partition;
  if (!kept_ || !(kind == kind_)) {
    kept_.emplace(*loadbalance::find_partitioner(options.partition), parts, options.keep_factor,
                  options.regions_per_rank);
  }
  kind_ = std::move(kind);

  const geometry::Rect frame = rank.frame();
  statistics_.reset();
  if (options.owners_draw) {
    by_displays_ = loadbalance::cut_by_displays(frame, options.displays);
    if (!options.report_partition) return by_displays_;
  }
  std::vector<loadbalance::WeightedBox> all =
      loadbalance::gather_boxes(costed_.boxes, rank.communicator);
  all.insert(all.end(), large_.begin(), large_.end());
  const bool cuts_here = rank.number() == 0;
  loadbalance::Costs costs;
  if (cuts_here) costs = costs_of(frame, parts * options.regions_per_rank, std::move(all));
  if (cuts_here && !samples_.empty() && kept_->last().frame == frame) {
    std::vector<double> seconds;
    for (int k = 0; k < parts; ++k) seconds.push_back(samples_[first_rank + k].seconds);
    loadbalance::scale_to_measured(costs, kept_->last(), seconds);
  }
  if (options.owners_draw) {
    if (cuts_here) report(costs, by_displays_, parts);
    return by_displays_;
  }
  const std::uint64_t recomputed = kept_->recomputed();
  const double before = rank.communicator.seconds();
  const loadbalance::Partition& partition = kept_->next(costs, rank.communicator);
  const double taken = rank.communicator.seconds() - before;
  if (!options.report_partition || !cuts_here) return partition;
  report(costs, partition, parts);
  statistics_->kept = kept_->recomputed() == recomputed;
  if (!statistics_->kept) statistics_->seconds = taken;
  return partition;
}

void ScreenPartition::report(const loadbalance::Costs& costs,
                             const loadbalance::Partition& partition, int parts) {
  statistics_.emplace();
  statistics_->predicted = loadbalance::imbalance(loadbalance::loads(costs, partition, parts));
  loadbalance::Balance balance = loadbalance::balance(partition, costs.boxes, parts);
  statistics_->over_share = balance.over_share;
  statistics_->overlap = balance.overlap;
  statistics_->primitives = balance.primitives;
  statistics_->shared = balance.shared;
  statistics_->partition = partition;
  statistics_->loads = std::move(balance.loads);
}

loadbalance::Costs ScreenPartition::costs(RankContext& rank, int regions) {
  assert(rank.ranks() == 1);
  const auto [begin, end] = rank.own_primitives();
  std::vector<loadbalance::WeightedBox> boxes =
      groups(rank, {begin, end, group_triangles(rank.prepared.first_primitives.back(), regions)})
          .boxes;
  boxes.insert(boxes.end(), large_.begin(), large_.end());
  return costs_of(rank.frame(), regions, std::move(boxes));
}

void ScreenPartition::measure(const RankContext& rank) {
  const Phases& phases = rank.counts.phases;
  sample_ = {static_cast<double>(rank.counts.triangles.rasterized),
             static_cast<double>(rank.counts.shaded),
             phases.transform + phases.rasterize + phases.shade};
}

}  // namespace delray::raster
