// Values that all tiles of a frame have in common.
#pragma once

#include "loadbalance/task_grid.h"
#include "raytrace/first_hits/first_hits.h"
#include "raytrace/integrators/integrator_pool.h"
#include "raytrace/render.h"

namespace delray::raytrace {

struct TiledFrame {
  const Tracer* tracer;  // null where the scene is shared out over ranks
  const RenderOptions& options;
  const FrameContext& context;
  IntegratorPool& integrators;
  loadbalance::Blocks tiles;  // tile k is task k of the schedule
  // Of the window, on rank 0, whose tiles go there; null elsewhere, and where there are displays.
  image::ImageF* picture;
  const FirstHits* first_hits = nullptr;  // where the hits of camera rays are rasterized
};

}  // namespace delray::raytrace
