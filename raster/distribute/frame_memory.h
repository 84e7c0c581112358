// The memory of strategies from frame to frame, on one rank.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "raster/distribute/cluster_messages.h"
#include "raster/distribute/group_traffic.h"
#include "raster/distribute/hybrid_shares.h"
#include "raster/distribute/primitive_shares.h"
#include "raster/distribute/scene_cells.h"
#include "raster/distribute/screen_partition.h"

namespace delray::raster {

// The last frame of a rank of sort-first.
struct SortedFirst {
  std::optional<Travel> travel;  // none: there was no frame
  std::uint64_t version = 0;     // of the screen's partition
  GroupTraffic traffic;
  DrawList list;
};

// The last frame of a rank of sort-middle.
struct SortedMiddle {
  std::uint64_t version = 0;         // of the screen's partition; 0: there was no frame
  DrawList list;                     // numbered over all ranks
  std::deque<ArrivedMesh> arrived;   // from other ranks; of the list, too
  std::vector<std::uint32_t> drawn;  // clusters of the list
  std::vector<int> rank_of_owner;    // which rank draws a region; empty: as the roles say
};

struct FrameMemory {
  ScreenPartition screen;
  SortedFirst sorted_first;
  SortedMiddle sorted_middle;
  SharedOut shared_out;              // of hybrid
  SceneCells cells;                  // of sort-last, blended in order
  PrimitiveShares primitive_shares;  // of sort-last otherwise
};

}  // namespace delray::raster
