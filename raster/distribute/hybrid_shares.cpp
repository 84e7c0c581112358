// Shares out screen and primitives together (Samanta et al. 2000): bounds groups, exchanges their
// boxes and costs, computes the same partition on every rank, and sends each group to its owner.
//
// A group that everybody draws goes to the ranks whose regions it touches, and the ranges of such
// groups are exchanged, since their pixels need not travel. O(groups) for each rank, and a message
// of 16 bytes a visible group to all ranks.
//
// Degenerate: without a visible group nobody draws anything.
#include "raster/distribute/hybrid_shares.h"

#include <algorithm>

#include "comm/collectives.h"
#include "loadbalance/region_index.h"
#include "raster/distribute/frame_memory.h"

namespace delray::raster {
namespace {

// A group costs a rank about as much as a pixel by being told of; smaller ones spare pixels.
constexpr std::uint64_t kGroupsPerRank = 250;
constexpr std::uint64_t kLargestGroup = 256;  // triangles

// The ranges of everybody's groups on all ranks. A message only where there are any.
std::vector<PrimitiveRange> find_everybodys(const RankContext& rank, std::span<const Piece> groups,
                                            const Shares& shares) {
  const std::vector<int>& owners = shares.partition.owners;
  std::vector<PrimitiveRange> ranges;
  if (std::find(owners.begin(), owners.end(), loadbalance::kEverybody) == owners.end())
    return ranges;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (owners[shares.first + i] == loadbalance::kEverybody)
      ranges.push_back({groups[i].primitive, groups[i].primitive + groups[i].count});
  }
  const std::vector<comm::Buffer> all = comm::all_gather(
      rank.communicator, comm::Buffer::of(std::span<const PrimitiveRange>(ranges)));
  ranges.clear();
  for (const comm::Buffer& buffer : all) {
    const auto of_rank = buffer.as<PrimitiveRange>();
    ranges.insert(ranges.end(), of_rank.begin(), of_rank.end());
  }
  return ranges;
}

}  // namespace

VisibleGroups find_visible_groups(RankContext& rank) {
  const std::uint64_t all = rank.first_primitives.back();
  const std::uint64_t triangles =
      std::clamp(all / (kGroupsPerRank * static_cast<std::uint64_t>(rank.ranks())),
                 std::uint64_t{1}, kLargestGroup);
  const auto [first, last] = rank.own_primitives();
  std::vector<Piece> groups = groups_of(pieces_of(rank.scene, rank.first_primitives, first, last),
                                        static_cast<std::uint32_t>(triangles));
  SeenSamples seen;
  const std::vector<loadbalance::WeightedBox> boxes =
      rank.memory.screen.boxes_of(rank, groups, &seen);
  const double per_pixel = 1.0 / rank.samples_per_pixel();
  std::vector<GroupBox> visible;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const auto& [x0, y0, x1, y1] = boxes[i].box;
    if (boxes[i].box.empty()) continue;
    const double cost = boxes[i].cost / seen.price + seen.large[i];
    const double setup = std::max(0.0, cost - seen.all[i]);
    groups[visible.size()] = groups[i];
    visible.push_back({static_cast<std::uint16_t>(x0), static_cast<std::uint16_t>(y0),
                       static_cast<std::uint16_t>(x1), static_cast<std::uint16_t>(y1),
                       static_cast<float>(cost * per_pixel),
                       static_cast<float>(setup * per_pixel)});
  }
  groups.resize(visible.size());
  return {std::move(groups), std::move(visible)};
}

Shares share_out(const RankContext& rank, const VisibleGroups& visible) {
  Shares shares;
  const std::vector<comm::Buffer> all =
      comm::all_gather(rank.communicator, comm::Buffer::of(std::span(visible.boxes)));
  for (int k = 0; k < rank.ranks(); ++k) {
    if (k == rank.number()) shares.first = shares.boxes.size();
    for (const GroupBox& box : all[k].as<GroupBox>())
      shares.boxes.push_back({{box.x0, box.y0, box.x1, box.y1}, box.cost, box.setup});
  }
  shares.partition = loadbalance::hybrid_partition(shares.boxes, rank.frame(), rank.ranks());
  shares.everybodys = find_everybodys(rank, visible.groups, shares);
  return shares;
}

std::vector<Piece> send_to_owners(RankContext& rank, std::span<const Piece> groups,
                                  const Shares& shares, Arrivals& arrivals) {
  std::vector<std::vector<Piece>> leaving(static_cast<std::size_t>(rank.ranks()));
  const loadbalance::RegionIndex index(shares.partition.regions);
  std::vector<int> owners;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    owners = {shares.partition.owners[shares.first + i]};
    if (owners.front() == loadbalance::kEverybody)
      index.owners_of(shares.boxes[shares.first + i].box, owners);
    for (const int owner : owners) leaving[owner].push_back(groups[i]);
  }
  std::vector<Piece> staying = std::move(leaving[rank.number()]);
  const bool geometry_travels = rank.options.travel == Travel::geometry;
  std::vector<comm::Parcel> parcels;
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

}  // namespace delray::raster
