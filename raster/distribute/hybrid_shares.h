// Who draws what and owns which part of the screen, where both are shared out together.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "image/image.h"
#include "loadbalance/hybrid_partition.h"
#include "raster/distribute/group_traffic.h"
#include "raster/distribute/rank_context.h"
#include "raster/distribute/screen_partition.h"
#include "raster/distribute/tile_fragments.h"

namespace delray::raster {

// The box of a group, what it may cost and how much of that its triangles do, in pixels, as all
// ranks tell each other. A frame's sides have less than 16 bits.
struct GroupBox {
  std::uint16_t x0, y0, x1, y1;
  float cost, setup;
};

// This rank's own groups that are seen: element i of both is of one group.
struct VisibleGroups {
  std::vector<std::uint32_t> numbers;  // among all of this rank's, ascending
  std::vector<GroupBox> boxes;
};
VisibleGroups find_visible_groups(const RankContext& rank, const CostedGroups& costed);

// How screen and primitives are shared out; equal on all ranks.
struct HybridPlan {
  std::vector<loadbalance::WeightedBox> boxes;  // of all groups that are seen, by rank
  loadbalance::HybridPartition partition;
};

// The plan, and a rank's place in it.
struct Shares {
  std::shared_ptr<const HybridPlan> plan;
  std::size_t first = 0;                   // this rank's boxes among those of all
  std::vector<PrimitiveRange> everybodys;  // primitives of groups that everybody draws, ascending
};
// Collective: every rank gets all boxes, and then the ranges of everybody's groups, if any.
Shares share_out(const RankContext& rank, const CostedGroups& costed, const VisibleGroups& visible);

// How a frame was shared out, and what a rank draws of it.
struct SharedOut {
  std::optional<Travel> travel;  // none: there was no frame
  std::uint64_t version = 0;     // of the groups' costs
  Shares shares;
  GroupTraffic traffic;
  DrawList list;
  // Memory of a frame: by tile and position in it, which triangle of the list is seen there.
  image::Plane<std::uint32_t> numbers;
};

// Shares out screen and groups, unless all is as in the last frame, and sends every group to its
// owner, everybody's to the ranks whose regions they touch, where these do not have it. Collective.
SharedOut& share_out_frame(RankContext& rank);

}  // namespace delray::raster
