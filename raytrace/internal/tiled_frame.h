// What all tiles of a frame have in common.
#pragma once

#include "loadbalance/task_grid.h"
#include "raytrace/internal/walks.h"
#include "raytrace/render.h"

namespace delray::raytrace {

struct TiledFrame {
  const Tracer* tracer;  // null where the scene is shared out over ranks
  const RenderOptions& options;
  const Setting& setting;
  Walks& walks;
  loadbalance::Blocks tiles;  // tile k is task k of the schedule
};

}  // namespace delray::raytrace
