// A draw list into the tiles of a frame: clusters are culled, transformed, set up and drawn a few
// at a time, so that nothing of them has to be kept.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "parallel/progress.h"
#include "raster/pipeline/cluster_set_up.h"
#include "raster/pipeline/frame_tiles.h"

namespace delray::raster {

// Memory of a thread while it draws, kept from batch to batch and frame to frame.
struct Worker {
  struct TileCounts {
    std::uint32_t fragments = 0, entries = 0, windows = 0, spots = 0, splats = 0;
  };
  struct TouchedTile {
    std::uint32_t tile;
    std::uint32_t first_fragment, last_fragment, first_entry, last_entry;
    std::uint32_t first_window, last_window, first_spot, last_spot, first_splat, last_splat;
  };

  std::size_t index = 0;  // among the drawing's
  ScreenVertices vertices;
  SetUpResult result;
  std::vector<TileCounts> counts;  // by tile; zero but while a batch is sorted
  std::vector<TouchedTile> touched;
  std::vector<Fragment> fragments;     // by tile
  std::vector<std::uint32_t> entries;  // by tile
  std::vector<std::uint32_t> windows;  // by tile
  std::vector<std::uint32_t> spots;    // by tile
  std::vector<std::uint32_t> splats;   // by tile
  std::vector<std::uint32_t> draws;    // of a batch
  std::uint64_t shaded = 0;            // pixels, as they were drawn
};

// Triangles by the tiles that they touch.
struct BinnedTriangles {
  std::vector<ScreenTriangle> triangles;
  std::vector<std::uint32_t> first;  // one more than tiles; empty when there are no triangles
  std::vector<std::uint32_t> entries;

  std::span<std::uint32_t> of_tile(int tile) {
    if (first.empty()) return {};
    return std::span(entries).subspan(first[tile], first[tile + 1] - first[tile]);
  }
};

// Triangles that are left for when everything else is drawn: those that touch many tiles, and those
// of blended draws.
struct DeferredTriangles {
  BinnedTriangles large, blended;
};

struct DrawIntoTiles {
  const Screen& screen;
  const DrawList& list;
  std::span<const PreparedDraw> draws;
  geometry::Rect clip;
  bool skip_hidden_clusters;
  // Whether alpha leaves anything of a triangle of a masked draw at a pixel. Called by threads that
  // each have a worker, by its index.
  std::function<bool(std::size_t worker, std::uint32_t number, int x, int y)> alpha_test;
  // Called for every pixel as soon as it shows another triangle, by the thread that has its tile;
  // pixels are drawn one by one then. Empty: never.
  std::function<void(std::size_t worker, std::uint32_t number, int x, int y)> shade_now;
  // Called whenever clusters were drawn into a tile, by the thread that has it, while their draws
  // are held. Empty: never.
  std::function<void(int number, VisibilityTile& tile)> tile_drawn = {};
  parallel::Progress* progress = nullptr;
};

// Seconds of processor time, summed over threads, and how often a pixel was shaded meanwhile.
struct DrawCosts {
  double set_up = 0, sort = 0, rasterize = 0;
  std::uint64_t shaded = 0;
};

// Numbers of clusters of the list, those of near draws first, of a draw those first that face the
// eye; else they stay in their order. O(clusters), parallel.
std::vector<std::uint32_t> nearest_first(const DrawIntoTiles& task,
                                         std::span<const std::uint32_t> clusters);

// In parts, for lists of which parts come later: gets the workers ready, whose memory is reused;
// draws clusters of the list in about the order given, in parallel, but for what is left for the
// end; hands that to `later` and returns what was counted.
void begin_drawing(const Screen& screen, std::vector<std::unique_ptr<Worker>>& workers);
void draw_clusters(const DrawIntoTiles& task, std::span<const std::uint32_t> clusters,
                   FrameTiles& tiles, std::span<const std::unique_ptr<Worker>> workers,
                   DrawCosts& costs);
TriangleCounts end_drawing(const Screen& screen, std::span<const std::unique_ptr<Worker>> workers,
                           DeferredTriangles& deferred, DrawCosts& costs);

// All of the list at once, nearest draws first.
TriangleCounts draw_into_tiles(const DrawIntoTiles& task, FrameTiles& tiles,
                               std::vector<std::unique_ptr<Worker>>& workers,
                               DeferredTriangles& deferred, DrawCosts& costs);

// A tile that a thread has for itself.
struct OwnTile {
  int number;
  geometry::Rect rect;
  VisibilityTile& visibility;
};
// Draws the large triangles of a tile, nearest first. Returns how often a pixel was shaded.
std::uint64_t draw_large(const DrawIntoTiles& task, std::size_t worker, BinnedTriangles& large,
                         const OwnTile& tile);

}  // namespace delray::raster
