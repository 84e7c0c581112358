// Sort-first: the screen is cut into regions of about equal cost, known from the boxes of groups of
// primitives on all ranks; each group goes to every rank whose region it touches, and the ranks
// draw their regions.
#include <algorithm>

#include "comm/collectives.h"
#include "loadbalance/costs.h"
#include "loadbalance/partition.h"
#include "loadbalance/region_index.h"
#include "parallel/parallel_for.h"
#include "raster/internal/extent.h"
#include "raster/internal/gather_regions.h"
#include "raster/internal/processor_seconds.h"
#include "raster/internal/rank.h"
#include "raster/internal/samples.h"
#include "raster/internal/travel.h"

namespace delray::raster {
namespace {

// Triangles in a group: few enough that its box is small, many enough that its header is not.
constexpr std::uint32_t kGroupTriangles = 256;
// What setting up a triangle costs, in pixels shaded.
constexpr double kTriangleCost = 0.5;

std::vector<Piece> groups_of(std::span<const Piece> pieces) {
  std::vector<Piece> groups;
  for (const Piece& piece : pieces)
    for (std::uint32_t done = 0; done < piece.count; done += kGroupTriangles)
      groups.push_back({piece.mesh, piece.transform, piece.first + done,
                        std::min(kGroupTriangles, piece.count - done), piece.primitive + done});
  return groups;
}

// The box of every group on the screen and what it may cost. Empty boxes cost nothing.
std::vector<loadbalance::WeightedBox> boxes_of(Rank& rank, std::span<const Piece> groups) {
  const DrawList list = make_draw_list({groups.begin(), groups.end()}, &rank.clusters);
  const std::vector<PreparedDraw> draws =
      prepare_draws(rank.screen, list, rank.shader, rank.options.cull_single_sided);
  // Draws are numbered in the order in which groups first name them.
  std::vector<std::uint32_t> draw_of(groups.size());
  std::uint32_t draw = 0;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (i > 0 && groups[i].transform != groups[i - 1].transform) ++draw;
    draw_of[i] = draw;
  }
  std::vector<loadbalance::WeightedBox> boxes(groups.size());
  ProcessorSeconds seconds;
  parallel::parallel_blocks(0, groups.size(), 4, [&](std::size_t begin, std::size_t end) {
    seconds.measure([&] {
      for (std::size_t i = begin; i < end; ++i) {
        const Extent e = extent(rank.screen, draws[draw_of[i]], groups[i].first, groups[i].count);
        boxes[i].box = pixels_of(e.box, rank.options.supersampling);
        boxes[i].cost =
            e.triangles == 0 ? 0 : kTriangleCost * groups[i].count + static_cast<double>(e.pixels);
      }
    });
  });
  rank.counts.phases.bin += seconds.seconds();
  return boxes;
}

loadbalance::Partition cut_screen(Rank& rank, std::span<const loadbalance::WeightedBox> boxes) {
  const geometry::Rect frame = rank.frame();
  const int side = loadbalance::cost_cell_side(frame, rank.ranks());
  loadbalance::Costs costs = loadbalance::make_costs(frame, (frame.width() + side - 1) / side,
                                                     (frame.height() + side - 1) / side, boxes);
  loadbalance::sum_over_ranks(costs, rank.communicator);
  return loadbalance::find_partitioner(rank.options.partition)
      ->partition(costs, frame, rank.ranks());
}

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
    partition = cut_screen(rank, boxes);
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
