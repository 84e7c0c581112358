// What strategies remember from frame to frame, on one rank.
#pragma once

#include "raster/distribute/group_traffic.h"
#include "raster/distribute/hybrid_shares.h"
#include "raster/distribute/scene_cells.h"
#include "raster/distribute/screen_partition.h"

namespace delray::raster {

struct FrameMemory {
  ScreenPartition screen;
  GroupTraffic traffic;
  SharedOut shared_out;  // of hybrid
  SceneCells cells;      // of sort-last, blended in order
};

}  // namespace delray::raster
