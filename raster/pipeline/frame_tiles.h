// The tiles of a frame, which threads change in turn.
#pragma once

#include <atomic>
#include <memory>
#include <span>
#include <vector>

#include "raster/pipeline/visibility.h"

namespace delray::raster {

// The rectangles of a tile that are to be rendered.
struct TileJob {
  int tile = 0;
  std::uint32_t first = 0, last = 0;  // into TileJobs::rects
};
struct TileJobs {
  std::vector<TileJob> jobs;  // ascending by tile, as they are made
  std::vector<geometry::Rect> rects;
  geometry::Rect clip;  // around all of them

  std::span<const geometry::Rect> rects_of(const TileJob& job) const {
    return std::span(rects).subspan(job.first, job.last - job.first);
  }
};
// The tiles of disjoint regions of the frame.
TileJobs make_tile_jobs(const Screen& screen, std::span<const geometry::Rect> regions);

// How far what is seen in a few blocks of the frame is.
struct DepthsAround {
  static constexpr int kMostBlocks = 256;
  int x0 = 0, y0 = 0, width = 0;  // in blocks
  bool may_hide = false;          // otherwise the rest is not set
  // Element (y - y0) * width + (x - x0): the code of the farthest depth in four blocks, (x, y) and
  // those to the right, below, and below to the right, but for those that were not asked for.
  std::int32_t farthest[kMostBlocks];
};

// Keeps its memory from frame to frame; tiles that nothing is drawn in are not touched.
class FrameTiles {
 public:
  void begin(const Screen& screen, const TileJobs& jobs);

  bool is_wanted(int tile) const { return state(tile) != State::unwanted; }
  bool is_drawn_in(int tile) const { return state(tile) == State::drawn; }
  // Around the rectangles of the tile that are to be rendered.
  const geometry::Rect& rect(int tile) const { return places_[tile].rect; }

  // For changes: whoever gets true has the tile for itself until unlock.
  bool try_lock(int tile) {
    return !places_[tile].locked.load(std::memory_order_relaxed) &&
           !places_[tile].locked.exchange(true, std::memory_order_acquire);
  }
  void unlock(int tile) { places_[tile].locked.store(false, std::memory_order_release); }
  // Cleared if nothing was drawn in it yet. REQUIRES: the tile is wanted, and locked or the
  // caller's alone.
  VisibilityTile& open(int tile);

  // Whether everything at or behind `depth` is hidden in these pixels of the frame, as far as is
  // known at a glance.
  bool is_hidden(const geometry::Rect& pixels, float depth) const;

  // What is known of the blocks that the pixels touch; nothing if they are many, or if what is not
  // behind `depth` is not hidden in any of them.
  void look_around(const geometry::Rect& pixels, float depth, DepthsAround& result) const;

 private:
  std::int32_t farthest_of(int block_x, int block_y) const;

  enum class State : std::uint8_t { unwanted, untouched, drawn };
  struct Place {
    geometry::Rect rect;
    std::atomic<bool> locked{false};
    std::atomic<State> state{State::unwanted};
  };
  State state(int tile) const { return places_[tile].state.load(std::memory_order_acquire); }

  int tiles_x_ = 0;
  std::size_t size_ = 0;
  std::unique_ptr<VisibilityTile[]> tiles_;
  std::unique_ptr<Place[]> places_;
};

}  // namespace delray::raster
