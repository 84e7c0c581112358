// Shares out screen and primitives together (Samanta et al. 2000): bounds groups, exchanges their
// boxes and costs, computes the same partition on every rank, and sends each group to its owner,
// unless that was sent it lately.
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
// Of all ranks, as each looks at all of them.
constexpr std::uint64_t kMostGroups = std::uint64_t{1} << 16;
constexpr std::uint64_t kLargestGroup = 1024;  // triangles

// The ranges of everybody's groups on all ranks. A message only where there are any.
std::vector<PrimitiveRange> find_everybodys(const RankContext& rank, const CostedGroups& costed,
                                            const VisibleGroups& visible, const Shares& shares) {
  const std::vector<int>& owners = shares.plan->partition.owners;
  std::vector<PrimitiveRange> ranges;
  if (std::find(owners.begin(), owners.end(), loadbalance::kEverybody) == owners.end())
    return ranges;
  for (std::size_t i = 0; i < visible.numbers.size(); ++i) {
    if (owners[shares.first + i] != loadbalance::kEverybody) continue;
    const Piece& group = costed.groups[visible.numbers[i]];
    ranges.push_back({group.primitive, group.primitive + group.count});
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

const CostedGroups& cost_groups(RankContext& rank) {
  const std::uint64_t all = rank.prepared.first_primitives.back();
  const std::uint64_t triangles = std::clamp(
      all / std::min(kGroupsPerRank * static_cast<std::uint64_t>(rank.ranks()), kMostGroups),
      std::uint64_t{1}, kLargestGroup);
  const auto [first, last] = rank.own_primitives();
  return rank.memory.screen.groups(rank, {first, last, static_cast<std::uint32_t>(triangles)},
                                   true);
}

// The list that this rank draws: its own groups and those that are sent to it, now or before.
// Collective.
DrawList exchange_groups(RankContext& rank, const CostedGroups& costed,
                         const VisibleGroups& visible, SharedOut& out) {
  const Shares& shares = out.shares;
  const loadbalance::RegionIndex index(shares.plan->partition.regions);
  std::size_t next = 0;  // of the visible groups
  return make_draw_list(
      out.traffic.exchange(rank, costed.groups,
                           [&](std::size_t group, std::vector<int>& owners) {
                             owners.clear();
                             if (next == visible.numbers.size() || visible.numbers[next] != group)
                               return;
                             const std::size_t i = shares.first + next++;
                             const int owner = shares.plan->partition.owners[i];
                             if (owner == loadbalance::kEverybody)
                               index.owners_of(shares.plan->boxes[i].box, owners);
                             else if (owner != loadbalance::kNobody)
                               owners = {owner};
                           }),
      &rank.prepared.clusters);
}

}  // namespace

VisibleGroups find_visible_groups(const RankContext& rank, const CostedGroups& costed) {
  const VisibleSamples& seen = costed.seen;
  const double per_pixel = 1.0 / rank.samples_per_pixel();
  VisibleGroups visible;
  for (std::size_t i = 0; i < costed.groups.size(); ++i) {
    const loadbalance::WeightedBox& group = costed.boxes[i];
    const auto& [x0, y0, x1, y1] = group.box;
    if (group.box.empty()) continue;
    const double cost = group.cost / seen.price + seen.large[i];
    const double setup = std::max(0.0, cost - seen.all[i]);
    visible.numbers.push_back(static_cast<std::uint32_t>(i));
    visible.boxes.push_back({static_cast<std::uint16_t>(x0), static_cast<std::uint16_t>(y0),
                             static_cast<std::uint16_t>(x1), static_cast<std::uint16_t>(y1),
                             static_cast<float>(cost * per_pixel),
                             static_cast<float>(setup * per_pixel)});
  }
  return visible;
}

Shares share_out(const RankContext& rank, const CostedGroups& costed,
                 const VisibleGroups& visible) {
  Shares shares;
  const std::vector<comm::Buffer> all =
      comm::all_gather(rank.communicator, comm::Buffer::of(std::span(visible.boxes)));
  for (int k = 0; k < rank.number(); ++k) shares.first += all[k].as<GroupBox>().size();
  shares.plan = std::static_pointer_cast<const HybridPlan>(
      rank.communicator.replicate([&]() -> std::shared_ptr<const void> {
        auto plan = std::make_shared<HybridPlan>();
        for (const comm::Buffer& of_rank : all) {
          for (const GroupBox& box : of_rank.as<GroupBox>())
            plan->boxes.push_back({{box.x0, box.y0, box.x1, box.y1}, box.cost, box.setup});
        }
        plan->partition = loadbalance::hybrid_partition(plan->boxes, rank.frame(), rank.ranks());
        return plan;
      }));
  shares.everybodys = find_everybodys(rank, costed, visible, shares);
  return shares;
}

SharedOut& share_out_frame(RankContext& rank) {
  comm::Communicator& communicator = rank.communicator;
  communicator.mark(comm::Phase::transform, 0);
  const CostedGroups& costed = cost_groups(rank);
  SharedOut& out = rank.memory.shared_out;
  const std::uint64_t version = rank.memory.screen.version();
  communicator.mark(comm::Phase::redistribute, 0);
  if (out.travel == rank.options.travel && out.version == version) return out;
  timed(communicator, rank.counts.phases.redistribute, [&] {
    const VisibleGroups visible = find_visible_groups(rank, costed);
    out.shares = share_out(rank, costed, visible);
    out.list = exchange_groups(rank, costed, visible, out);
    out.travel = rank.options.travel;
    out.version = version;
    return true;
  });
  return out;
}

}  // namespace delray::raster
