// One rank's rendering: pieces of a scene into regions of the frame.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "composite/shown_blocks.h"
#include "parallel/function_ref.h"
#include "raster/distribute/block_cover.h"
#include "raster/render.h"
#include "raster/shading/tile_colours.h"
#include "raster/shading/tile_view.h"

namespace delray::raster {

// Memory that one frame leaves to the next.
struct Scratch {
  Picture spare;  // nobody's any more
  Picture part;   // the same, of a part of a frame
  // By tile: whether it is clear in the picture whose colours are at `clear_in`, or `taken` when
  // that picture was taken for the frame at hand; and whether this rank's regions of it are.
  std::vector<std::uint8_t> clear_tiles, empty_tiles;
  const void* clear_in = nullptr;
  const void* taken = nullptr;
  // The same by blocks of pixels, of the picture whose colours are at `shown_in`; where that is
  // null, of the one that was taken or made last.
  composite::ShownBlocks shown;
  const void* shown_in = nullptr;
  FrameTiles tiles;
  std::vector<std::unique_ptr<Worker>> workers;
  std::vector<std::unique_ptr<TileMemory>> tile_memory;  // by worker
  DeferredTriangles deferred;
  image::Plane<image::RgbaF> shaded;  // of a frame that is shaded as it is drawn
  // By tile, of drawings whose colours are looked up as they are drawn; and how many these were.
  std::vector<std::unique_ptr<TileColours>> tile_colours;
  std::uint64_t coloured = 0;
  // Of a drawing that was asked for them: numbers of the list and, of each, the pixel of the
  // screen.
  std::vector<std::uint32_t> seen;
  std::vector<std::uint64_t> seen_at;
  // By tile: whether others hid anything of it in the last drawing that was told.
  std::vector<std::uint8_t> partly_hidden;
};

// Times of rendering, summed over threads, and counts of the work.
struct RegionCounts {
  Phases phases;
  TriangleCounts triangles;
  std::uint64_t fragments = 0, shaded = 0, tiles = 0;

  void operator+=(const RegionCounts& other);
};

// A task: a list to be rendered into regions. These, in pixels of the screen, are disjoint.
struct RegionTask {
  const Screen& screen;
  const DrawList& list;
  const shading::Shader& shader;
  const RenderOptions& options;
  std::span<const geometry::Rect> regions;
  bool distances;  // depths are distances rather than -near / distance
  parallel::Progress* progress;
};

// The list's draws as drawing and shading want them: what drawings of the same list share.
class PreparedFrame {
 public:
  explicit PreparedFrame(const RegionTask& task);
  // Prepares the draws that the list has got since. The others may have moved.
  void add_draws(const RegionTask& task);

  const FrameShading& shading() const { return shading_; }
  std::span<const PreparedDraw> draws() const { return draws_; }

 private:
  std::vector<PreparedDraw> draws_;
  FrameShading shading_;
};

using FinishTile = parallel::FunctionRef<void(std::span<const geometry::Rect>, TileView&)>;
// Rows [begin, end) of the screen's tiles are finished; what was done since the last call.
using RowsFinished = parallel::FunctionRef<void(int begin, int end, const RegionCounts& done)>;

// A frame under way. The list may be given more draws and clusters until `finish`; calls are the
// rank's own thread's.
class RegionDrawing {
 public:
  RegionDrawing(const RegionTask& task, Scratch& scratch);
  // A drawing of a list to which nothing is added, prepared by the caller, who keeps the frame.
  RegionDrawing(const RegionTask& task, const PreparedFrame& frame, Scratch& scratch);
  RegionDrawing(const RegionDrawing&) = delete;
  RegionDrawing& operator=(const RegionDrawing&) = delete;

  // The frame of the list's draws as they were when anything was drawn last, or at first.
  const FrameShading& frame() const { return frame_->shading(); }
  std::span<const PreparedDraw> draws() const { return frame_->draws(); }
  // Numbers of clusters, those of near draws first.
  std::vector<std::uint32_t> nearest_first(std::span<const std::uint32_t> clusters) const;

  // Draws these clusters of the list, near draws first or as they are given. Parallel.
  void draw(std::span<const std::uint32_t> clusters);
  void draw_in_order(std::span<const std::uint32_t> clusters);
  void draw_all();
  // Whether nothing at or behind `depth` can be seen any more in these samples, as far as is known
  // at a glance.
  bool hides(const geometry::Rect& samples, float depth) const;
  // By tile of the screen and block in it, what all that is drawn by now hides; and that nothing
  // hidden by such covers need be shaded. To be called after all was drawn. Not for drawings in
  // which anything is blended or was shaded already.
  std::span<const BlockCover> find_covers() {
    return covers_ = covers_of(scratch_.tiles, task_.screen);
  }
  void hide_behind(std::span<const BlockCover> others) {
    hidden_behind_.assign(others.begin(), others.end());
    scratch_.partly_hidden.resize(static_cast<std::size_t>(task_.screen.tiles()));
  }
  // Those of a tile's blocks that may hide anything that it shows. REQUIRES: drawing has ended;
  // hide_behind was called.
  std::array<BlockCover, VisibilityTile::kBlocks> hidden_behind(int tile) const;
  // Puts into Scratch::seen, as tiles are finished, of one in 64 of their pixels the number of the
  // triangle that is seen there, if any, and of those that are blended before it, in any order.
  void sample_seen();
  // Takes samples of these pixels of the screen out of them again.
  void drop_samples(parallel::FunctionRef<bool(std::uint64_t pixel)> drops);
  // Columns and rows of tiles around all that is drawn by now, or waits for the end.
  geometry::Rect tiles_seen() const;
  // Hands every tile that the regions touch to finish_tile(rects, view), where `rects` are the
  // parts of regions in it. Parallel. To be called once, in the end.
  RegionCounts finish(FinishTile finish_tile);
  // Before finish, does those of its tiles that are wanted, a few at a time, for as long as more()
  // says so, which is called in the caller's thread. Returns them.
  std::span<const TileJob> finish_some(FinishTile finish_tile,
                                       parallel::FunctionRef<bool(int tile)> wanted,
                                       parallel::FunctionRef<bool()> more);
  // As finish, `rows` rows of tiles at a time, from row `first` on and from the top to it again.
  // After each time rows_finished is called, in the caller's thread.
  //
  // REQUIRES: 0 <= first < the screen's rows of tiles; rows >= 1.
  void finish_rows(int first, int rows, FinishTile finish_tile, RowsFinished rows_finished);

 private:
  RegionDrawing(const RegionTask& task, std::unique_ptr<PreparedFrame> own,
                const PreparedFrame* frame, Scratch& scratch);
  void end_drawing();
  void find_large(int tile, std::vector<std::uint32_t>& draws) const;
  void find_seen(const TileJob& job, const VisibilityTile* tile, TileMemory& memory,
                 std::vector<std::uint32_t>& draws) const;
  void drop_hidden(int tile, VisibilityTile& visibility);
  void sample_seen(const TileJob& job, const VisibilityTile* tile,
                   std::span<const BlendedFragment> blended, std::vector<std::uint32_t>& numbers,
                   std::vector<std::uint64_t>& at) const;
  bool looks_up_colours() const { return into_tiles_.tile_drawn != nullptr; }
  ShadedPixels shaded_pixels(int tile) const;
  void finish_jobs(std::span<const TileJob> jobs, FinishTile finish_tile);

  const RegionTask task_;
  Scratch& scratch_;
  TileJobs tiles_;
  std::unique_ptr<PreparedFrame> own_frame_;
  const PreparedFrame* frame_;
  MeshHolder* const holder_;  // of tiles that are finished; null: what was drawn is there
  DrawIntoTiles into_tiles_;
  DrawCosts costs_;
  std::vector<BlockCover> covers_, hidden_behind_;  // empty: nothing is known
  bool samples_seen_ = false;
  std::size_t finished_ = 0;  // jobs
  RegionCounts counts_;       // of these, from when drawing ended
};

}  // namespace delray::raster
