// Who draws what and owns which part of the screen, where both are shared out together.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "loadbalance/hybrid_partition.h"
#include "raster/distribute/rank_context.h"
#include "raster/distribute/tile_fragments.h"
#include "raster/distribute/travel.h"

namespace delray::raster {

// The box of a group, what it may cost and how much of that its triangles do, in pixels, as all
// ranks tell each other. A frame's sides have less than 16 bits.
struct GroupBox {
  std::uint16_t x0, y0, x1, y1;
  float cost, setup;
};

// This rank's own groups that are seen, and their boxes. Collective.
struct VisibleGroups {
  std::vector<Piece> groups;
  std::vector<GroupBox> boxes;
};
VisibleGroups find_visible_groups(RankContext& rank);

// The same on all ranks.
struct Shares {
  std::vector<loadbalance::WeightedBox> boxes;  // of all groups that are seen, by rank
  std::size_t first = 0;                        // this rank's among them
  loadbalance::HybridPartition partition;
  std::vector<PrimitiveRange> everybodys;  // primitives of groups that everybody draws, ascending
};
// Collective: every rank gets all boxes, and then the ranges of everybody's groups, if any.
Shares share_out(const RankContext& rank, const VisibleGroups& visible);

// How a frame was shared out, and what a rank draws of it.
struct SharedOut {
  Shares shares;
  Arrivals arrivals;
  std::vector<Piece> pieces;
  std::optional<Travel> travel;  // none: there was no frame
};

// Sends every group to its owner, everybody's to the ranks whose regions they touch. Returns this
// rank's, with those that arrived. Collective.
std::vector<Piece> send_to_owners(RankContext& rank, std::span<const Piece> groups,
                                  const Shares& shares, Arrivals& arrivals);

}  // namespace delray::raster
