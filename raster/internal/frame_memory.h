// What strategies remember from frame to frame, on one rank.
#pragma once

#include "raster/internal/group_traffic.h"
#include "raster/internal/hybrid_shares.h"
#include "raster/internal/scene_cells.h"
#include "raster/internal/screen_partition.h"

namespace delray::raster {

struct FrameMemory {
  ScreenPartition screen;
  GroupTraffic traffic;
  SharedOut shared_out;  // of hybrid
  SceneCells cells;      // of sort-last, blended in order
};

}  // namespace delray::raster
