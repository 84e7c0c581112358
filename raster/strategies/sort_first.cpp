// Sort-first: the screen is cut into regions of about equal cost, known from the boxes of groups of
// primitives on all ranks; each group goes to every rank whose region it touches, and the ranks
// draw their regions. From frame to frame, regions stay as long as they are even enough, and groups
// where they have been sent; where nothing has changed, nothing is looked at again.
#include "loadbalance/region_index.h"
#include "raster/distribute/frame_memory.h"
#include "raster/distribute/rank_context.h"

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

}  // namespace

Picture sort_first(RankContext& rank) {
  if (!rank.options.schedule.empty()) return sort_first_scheduled(rank);
  return rank.options.float_pixels ? render<image::RgbaF>(rank) : render<image::Rgba8>(rank);
}

}  // namespace delray::raster
