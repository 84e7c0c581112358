// Sort-first: the screen is cut into regions of about equal cost, known from the boxes of groups of
// primitives on all ranks; each group goes to every rank whose region it touches, and the ranks
// draw their regions. From frame to frame, regions stay as long as they are even enough, and groups
// where they have been sent.
#include "loadbalance/region_index.h"
#include "raster/distribute/frame_memory.h"
#include "raster/distribute/rank_context.h"

namespace delray::raster {
namespace {

template <class Colour>
Picture render(RankContext& rank) {
  comm::Communicator& communicator = rank.communicator;
  communicator.mark(comm::Phase::transform, 0);
  const auto [begin, end] = rank.own_primitives();
  const std::uint32_t triangles = ScreenPartition::group_triangles(
      rank.first_primitives.back(), rank.ranks() * rank.options.regions_per_rank);
  const std::vector<Piece> groups =
      groups_of(pieces_of(rank.scene, rank.first_primitives, begin, end), triangles);
  ScreenPartition& screen = rank.memory.screen;
  const std::vector<loadbalance::WeightedBox> boxes = screen.boxes_of(rank, groups);

  communicator.mark(comm::Phase::redistribute, 0);
  const double before_exchange = communicator.seconds();
  const loadbalance::Partition& partition = screen.cut(rank, boxes, rank.ranks());
  const loadbalance::RegionIndex index(partition);
  const DrawList list =
      make_draw_list(rank.memory.traffic.exchange(rank, groups,
                                                  [&](std::size_t group, std::vector<int>& owners) {
                                                    index.owners_of(boxes[group].box, owners);
                                                  }),
                     &rank.clusters);
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
