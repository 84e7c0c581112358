// One rank's rendering: pieces of a scene into regions of the frame.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "parallel/function_ref.h"
#include "raster/internal/tile_view.h"
#include "raster/render.h"

namespace delray::raster {

// Memory that one frame leaves to the next.
struct Scratch {
  Picture spare;  // nobody's any more
  FrameTiles tiles;
  std::vector<std::unique_ptr<Worker>> workers;
  LaterTriangles later;
  image::Plane<image::RgbaF> shaded;  // of a frame that is shaded as it is drawn
};

// What rendering took, summed over threads, and what it did.
struct RegionCounts {
  Phases phases;
  TriangleCounts triangles;
  std::uint64_t fragments = 0, shaded = 0, tiles = 0;

  void operator+=(const RegionCounts& other);
};

// What is to be rendered. The regions, in pixels of the screen, are disjoint.
struct RegionTask {
  const Screen& screen;
  const DrawList& list;
  const shading::Shader& shader;
  const RenderOptions& options;
  std::span<const geometry::Rect> regions;
  bool distances;  // depths are distances rather than -near / distance
  parallel::Progress* progress;
};

// Draws the list, then hands every tile that the regions touch to finish(rects, view), where
// `rects` are the parts of regions in it. Parallel: batches of clusters, then tiles.
using FinishTile = parallel::FunctionRef<void(std::span<const geometry::Rect>, TileView&)>;
RegionCounts render_regions(const RegionTask& task, Scratch& scratch, FinishTile finish);

}  // namespace delray::raster
