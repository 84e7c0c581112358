// Sort-first: the screen is cut into regions of about equal cost, known from the boxes of groups of
// primitives on all ranks; each group goes to every rank whose region it touches, and the ranks
// draw their regions.
#include "comm/collectives.h"
#include "loadbalance/partition.h"
#include "loadbalance/region_index.h"
#include "raster/internal/gather_regions.h"
#include "raster/internal/rank.h"
#include "raster/internal/screen_partition.h"
#include "raster/internal/travel.h"

namespace delray::raster {
namespace {

// Keeps the groups that touch a region of this rank's, sends every group to the other ranks whose
// regions it touches, and adds what arrives.
std::vector<Piece> redistribute(Rank& rank, std::span<const Piece> groups,
                                std::span<const loadbalance::WeightedBox> boxes,
                                const loadbalance::Partition& partition, Arrivals& arrivals) {
  std::vector<std::vector<Piece>> leaving(static_cast<std::size_t>(rank.ranks()));
  const loadbalance::RegionIndex index(partition);
  std::vector<int> owners;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    index.owners_of(boxes[i].box, owners);
    for (const int owner : owners) leaving[owner].push_back(groups[i]);
  }

  const bool geometry_travels = rank.options.travel == Travel::geometry;
  std::vector<comm::Parcel> parcels;
  std::vector<Piece> staying = std::move(leaving[rank.number()]);
  for (int k = 0; k < rank.ranks(); ++k) {
    if (k == rank.number() || leaving[k].empty()) continue;
    for (const Piece& piece : leaving[k]) rank.triangles_travelled += piece.count;
    parcels.push_back({k, geometry_travels ? pack_geometry(leaving[k]) : pack_numbers(leaving[k])});
  }
  for (const comm::Parcel& parcel : comm::exchange(rank.communicator, std::move(parcels))) {
    if (geometry_travels)
      unpack_geometry(parcel.message, arrivals);
    else
      unpack_numbers(parcel.message, rank.scene, rank.first_primitives, arrivals);
  }
  staying.insert(staying.end(), arrivals.pieces.begin(), arrivals.pieces.end());
  return staying;
}

template <class Colour>
Picture render(Rank& rank) {
  comm::Communicator& communicator = rank.communicator;
  communicator.mark(comm::Phase::transform, 0);
  const auto [begin, end] = rank.own_primitives();
  const std::vector<Piece> groups =
      groups_of(pieces_of(rank.scene, rank.first_primitives, begin, end));
  const std::vector<loadbalance::WeightedBox> boxes = boxes_of(rank, groups);

  communicator.mark(comm::Phase::redistribute, 0);
  Arrivals arrivals;
  loadbalance::Partition partition;
  const DrawList list = timed(communicator, rank.counts.phases.redistribute, [&] {
    partition = cut_screen(rank, boxes, rank.ranks());
    return make_draw_list(redistribute(rank, groups, boxes, partition, arrivals), &rank.clusters);
  });

  std::vector<geometry::Rect> regions;
  for (const loadbalance::Region& region : partition.regions)
    if (region.owner == rank.number()) regions.push_back(region.rect);
  auto image = rank.take_image<Colour>(rank.options.width, rank.options.height);
  rank.render_pixels(list, regions, image);

  communicator.mark(comm::Phase::gather, 0);
  const double before = communicator.seconds();
  gather_regions(communicator, partition, image);
  rank.counts.phases.gather += communicator.seconds() - before;
  if (rank.number() != 0) return image::BasicImage<Colour>();
  return image;
}

}  // namespace

Picture sort_first(Rank& rank) {
  return rank.options.float_pixels ? render<image::RgbaF>(rank) : render<image::Rgba8>(rank);
}

}  // namespace delray::raster
