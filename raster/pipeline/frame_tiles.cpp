// Finds the tiles of regions, and tells from the farthest depths of blocks what is hidden before it
// is drawn (hierarchical Z-buffer: Greene et al. 1993).
//
// The values of a cluster's blocks are merged by fours, so that a triangle of up to two by two
// blocks needs a single one. Degenerate: boxes of many blocks or tiles are not looked up, and count
// as seen.
#include "raster/pipeline/frame_tiles.h"

#include <algorithm>

namespace delray::raster {
namespace {

geometry::Rect hull(const geometry::Rect& a, const geometry::Rect& b) {
  return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

}  // namespace

TileJobs make_tile_jobs(const Screen& screen, std::span<const geometry::Rect> regions) {
  struct Overlap {
    int tile;
    geometry::Rect rect;
  };
  std::vector<Overlap> overlaps;
  for (const geometry::Rect& region : regions) {
    const geometry::Rect r = geometry::intersection(region, screen.frame());
    if (r.empty()) continue;
    for (int y = r.y0 / kTileSize; y <= (r.y1 - 1) / kTileSize; ++y) {
      for (int x = r.x0 / kTileSize; x <= (r.x1 - 1) / kTileSize; ++x) {
        const int tile = y * screen.tiles_x + x;
        overlaps.push_back({tile, geometry::intersection(r, screen.tile(tile))});
      }
    }
  }
  std::stable_sort(overlaps.begin(), overlaps.end(),
                   [](const Overlap& a, const Overlap& b) { return a.tile < b.tile; });
  TileJobs result;
  for (const Overlap& overlap : overlaps) {
    const auto at = static_cast<std::uint32_t>(result.rects.size());
    if (result.jobs.empty() || result.jobs.back().tile != overlap.tile)
      result.jobs.push_back({overlap.tile, at, at});
    result.rects.push_back(overlap.rect);
    ++result.jobs.back().last;
    result.clip = at == 0 ? overlap.rect : hull(result.clip, overlap.rect);
  }
  return result;
}

void FrameTiles::begin(const Screen& screen, const TileJobs& jobs) {
  const auto tiles = static_cast<std::size_t>(screen.tiles());
  if (size_ < tiles) {
    size_ = tiles;
    tiles_.reset(new VisibilityTile[tiles]);  // not initialised
    places_ = std::make_unique<Place[]>(tiles);
  }
  tiles_x_ = screen.tiles_x;
  for (std::size_t i = 0; i < size_; ++i) {
    places_[i].locked.store(false, std::memory_order_relaxed);
    places_[i].state.store(State::unwanted, std::memory_order_relaxed);
  }
  for (const TileJob& job : jobs.jobs) {
    Place& place = places_[job.tile];
    place.rect = {};
    for (const geometry::Rect& r : jobs.rects_of(job))
      place.rect = place.rect.empty() ? r : hull(place.rect, r);
    place.state.store(State::untouched, std::memory_order_relaxed);
  }
}

VisibilityTile& FrameTiles::open(int tile) {
  if (state(tile) == State::untouched) {
    tiles_[tile].clear(places_[tile].rect);
    places_[tile].state.store(State::drawn, std::memory_order_release);
  }
  return tiles_[tile];
}

// Coordinates are not negative.
std::int32_t FrameTiles::farthest_of(int block_x, int block_y) const {
  constexpr int kBlocksY = VisibilityTile::kBlocks / VisibilityTile::kBlocksX;
  const int tile = block_y / kBlocksY * tiles_x_ + block_x / VisibilityTile::kBlocksX;
  const State now = state(tile);
  if (now != State::drawn) return now == State::untouched ? kEmptyCode : 0;
  return tiles_[tile].farthest_of(block_y % kBlocksY * VisibilityTile::kBlocksX +
                                  block_x % VisibilityTile::kBlocksX);
}

void FrameTiles::look_around(const geometry::Rect& pixels, float depth,
                             DepthsAround& result) const {
  const int x0 = pixels.x0 / VisibilityTile::kBlockWidth;
  const int y0 = pixels.y0 / VisibilityTile::kBlockHeight;
  const int width = (pixels.x1 - 1) / VisibilityTile::kBlockWidth - x0 + 1;
  const int height = (pixels.y1 - 1) / VisibilityTile::kBlockHeight - y0 + 1;
  result.may_hide = false;
  if (pixels.empty() || width > DepthsAround::kMostBlocks ||
      width * height > DepthsAround::kMostBlocks)
    return;
  result.x0 = x0;
  result.y0 = y0;
  result.width = width;
  std::int32_t nearest = kEmptyCode;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      std::int32_t& here = result.farthest[y * width + x];
      here = farthest_of(x0 + x, y0 + y);
      nearest = std::min(nearest, here);
    }
  }
  result.may_hide = nearest < code_of_depth(depth);
  if (!result.may_hide) return;
  for (int y = 0; y < height; ++y) {
    std::int32_t* const row = result.farthest + y * width;
    for (int x = 0; x + 1 < width; ++x) row[x] = std::max(row[x], row[x + 1]);
  }
  for (int i = 0; i < (height - 1) * width; ++i)
    result.farthest[i] = std::max(result.farthest[i], result.farthest[i + width]);
}

bool FrameTiles::is_hidden(const geometry::Rect& pixels, float depth) const {
  constexpr int kMostTiles = 6;
  const std::int32_t code = code_of_depth(depth);
  const int x0 = pixels.x0 / kTileSize, x1 = (pixels.x1 - 1) / kTileSize;
  const int y0 = pixels.y0 / kTileSize, y1 = (pixels.y1 - 1) / kTileSize;
  if ((x1 - x0 + 1) * (y1 - y0 + 1) > kMostTiles) return false;
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const int index = y * tiles_x_ + x;
      const State now = state(index);
      if (now == State::unwanted) continue;
      if (now == State::untouched) return false;
      const int i0 = std::max(pixels.x0 - x * kTileSize, 0) / VisibilityTile::kBlockWidth;
      const int j0 = std::max(pixels.y0 - y * kTileSize, 0) / VisibilityTile::kBlockHeight;
      const int i1 =
          std::min(pixels.x1 - 1 - x * kTileSize, kTileSize - 1) / VisibilityTile::kBlockWidth;
      const int j1 =
          std::min(pixels.y1 - 1 - y * kTileSize, kTileSize - 1) / VisibilityTile::kBlockHeight;
      for (int j = j0; j <= j1; ++j) {
        for (int i = i0; i <= i1; ++i)
          if (code <= tiles_[index].farthest_of(j * VisibilityTile::kBlocksX + i)) return false;
      }
    }
  }
  return true;
}

}  // namespace delray::raster
