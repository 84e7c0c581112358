// Sort-first: the screen is cut into regions of about equal cost, known from the boxes of groups of
// primitives on all ranks; each group goes to every rank whose region it touches, and the ranks
// draw their regions. From frame to frame, regions stay as long as they are even enough, and groups
// where they have been sent; where nothing has changed, nothing is looked at again.
#include "comm/agree_on_failure.h"
#include "loadbalance/costs.h"
#include "loadbalance/region_index.h"
#include "raster/distribute/frame_memory.h"
#include "raster/distribute/rank_context.h"
#include "raster/packed/packed_drawing.h"
#include "raster/pipeline/samples.h"

namespace delray::raster {
namespace {

// Finds what this rank draws. Collective: groups travel unless all is as in the last frame.
const DrawList& draw_list(RankContext& rank, const CostedGroups& costed,
                          const loadbalance::Partition& partition) {
  SortedFirst& last = rank.memory.sorted_first;
  if (last.version == rank.memory.screen.version() && last.travel == rank.options.travel)
    return last.list;
  last.version = rank.memory.screen.version();
  last.travel = rank.options.travel;
  const loadbalance::RegionIndex index(partition);
  last.list =
      make_draw_list(last.traffic.exchange(rank, costed.groups,
                                           [&](std::size_t group, std::vector<int>& owners) {
                                             index.owners_of(costed.boxes[group].box, owners);
                                           }),
                     &rank.prepared.clusters);
  return last.list;
}

template <class Colour>
Picture render(RankContext& rank) {
  comm::Communicator& communicator = rank.communicator;
  communicator.mark(comm::Phase::transform, 0);
  const auto [begin, end] = rank.own_primitives();
  ScreenPartition& screen = rank.memory.screen;
  const CostedGroups& costed = screen.groups(
      rank, {begin, end,
             ScreenPartition::group_triangles(rank.prepared.first_primitives.back(),
                                              rank.ranks() * rank.options.regions_per_rank)});

  communicator.mark(comm::Phase::redistribute, 0);
  const double before_exchange = communicator.seconds();
  const loadbalance::Partition& partition = screen.cut(rank, rank.ranks());
  const DrawList& list = draw_list(rank, costed, partition);
  rank.counts.phases.redistribute += communicator.seconds() - before_exchange;

  std::vector<geometry::Rect> regions;
  for (const loadbalance::Region& region : partition.regions)
    if (region.owner == rank.number()) regions.push_back(region.rect);
  auto image = rank.take_image<Colour>(rank.options.width, rank.options.height);
  rank.render_pixels(list, regions, image);
  screen.measure(rank);

  return rank.gather(partition, std::move(image));
}

// The costs of pages, known on all ranks by the table alone: nothing need travel.
loadbalance::Costs costs_of_pages(const RankContext& rank, const PackedScene& packed,
                                  std::span<const PlacedPage> pages) {
  // Of the pixels of a page's box, that are expected to be seen: about as many lie behind others.
  constexpr double kSeen = 0.5;
  const loadbalance::RasterCostModel model = cost_model(rank.options.lighting);
  std::vector<loadbalance::WeightedBox> boxes;
  for (const PlacedPage& page : pages) {
    const auto triangles = static_cast<double>(packed.pack.pages()[page.page].triangles);
    const geometry::Rect box = pixels_of(page.pixels, rank.options.supersampling);
    boxes.push_back(
        {box,
         model.setup(triangles) + model.per_pixel * kSeen * static_cast<double>(page.pixels.area()),
         model.setup(std::sqrt(triangles)), packed.pack.pages()[page.page].triangles});
  }
  const geometry::Rect frame = rank.frame();
  const int side = loadbalance::cost_cell_side(frame, rank.ranks() * rank.options.regions_per_rank);
  return loadbalance::make_costs(frame, (frame.width() + side - 1) / side,
                                 (frame.height() + side - 1) / side, boxes);
}

// Each rank reads the pages that its regions show.
template <class Colour>
Picture render_pack(RankContext& rank, PackedScene& packed) {
  std::vector<PlacedPage> pages = visible_pages(rank, packed);
  const loadbalance::Partition partition = loadbalance::partition_for_ranks(
      *loadbalance::find_partitioner(rank.options.partition), costs_of_pages(rank, packed, pages),
      rank.ranks(), rank.options.regions_per_rank);
  std::vector<geometry::Rect> regions;
  for (const loadbalance::Region& region : partition.regions)
    if (region.owner == rank.number()) regions.push_back(region.rect);
  std::erase_if(pages, [&](const PlacedPage& page) {
    return std::none_of(regions.begin(), regions.end(), [&](const geometry::Rect& region) {
      return !geometry::intersection(samples_of(region, rank.options.supersampling), page.pixels)
                  .empty();
    });
  });
  auto image = rank.take_image<Colour>(rank.options.width, rank.options.height);
  rank.communicator.mark(comm::Phase::rasterize, 0);
  // A rank that cannot read a page would be waited for.
  comm::all_or_none(rank.communicator, comm::Phase::rasterize, [&] {
    PackedDrawing pack(rank, packed, std::move(pages));
    RegionDrawing drawing = rank.begin(pack.list(), regions);
    pack.draw(drawing);
    rank.end_pixels(drawing, image);
    pack.count();
  });
  return rank.gather(partition, std::move(image));
}

}  // namespace

Picture sort_first(RankContext& rank) {
  rank.composites = false;
  if (PackedScene* const packed = rank.prepared.packed) {
    return rank.options.float_pixels ? render_pack<image::RgbaF>(rank, *packed)
                                     : render_pack<image::Rgba8>(rank, *packed);
  }
  if (!rank.options.schedule.empty()) return sort_first_scheduled(rank);
  return rank.options.float_pixels ? render<image::RgbaF>(rank) : render<image::Rgba8>(rank);
}

}  // namespace delray::raster
