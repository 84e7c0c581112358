// Merges the covers of blocks over all ranks.
//
// A rank that is done before others finishes tiles meanwhile, with all that it has drawn in them.
// When the others' covers are known what they hide is emptied again, so that images, counts and
// samples are what they would be if it had waited.
#include "raster/distribute/others_depths.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstring>
#include <iterator>

#include "parallel/parallel_for.h"

namespace delray::raster {
namespace {

// A message has the tiles that were drawn in, and the covers of blocks.
constexpr std::size_t kTiles = sizeof(geometry::Rect) / sizeof(BlockCover);
static_assert(sizeof(geometry::Rect) % sizeof(BlockCover) == 0);

geometry::Rect tiles_of(const comm::Buffer& message) {
  geometry::Rect tiles;
  std::memcpy(&tiles, message.data(), sizeof(tiles));
  return tiles;
}
comm::Buffer message_of(const geometry::Rect& tiles, std::span<const BlockCover> covers) {
  comm::Buffer message(sizeof(tiles) + covers.size_bytes());
  std::memcpy(message.data(), &tiles, sizeof(tiles));
  std::ranges::copy(covers, message.as<BlockCover>().subspan(kTiles).begin());
  return message;
}
void merge(comm::Buffer& lower, comm::Buffer& upper) {
  const geometry::Rect a = tiles_of(lower), b = tiles_of(upper);
  const geometry::Rect tiles{std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1),
                             std::max(a.y1, b.y1)};
  std::memcpy(lower.data(), &tiles, sizeof(tiles));
  const std::span<BlockCover> covers = lower.as<BlockCover>().subspan(kTiles);
  std::ranges::transform(covers, upper.as<BlockCover>().subspan(kTiles), covers.begin(), merged);
}

// Empties what the covers of blocks hide in a tile that was finished before they were known.
// Returns how many pixels.
template <class Colour>
std::uint64_t drop_hidden(const geometry::Rect& tile, std::span<const BlockCover> covers,
                          image::BasicImage<Colour>& image) {
  constexpr int kWidth = VisibilityTile::kBlockWidth, kHeight = VisibilityTile::kBlockHeight;
  std::uint64_t dropped = 0;
  for (int block = 0; block < VisibilityTile::kBlocks; ++block) {
    const BlockCover& cover = covers[static_cast<std::size_t>(block)];
    const int x = tile.x0 + block % VisibilityTile::kBlocksX * kWidth;
    const int y = tile.y0 + block / VisibilityTile::kBlocksX * kHeight;
    if (cover.parts == 0 || x >= tile.x1) continue;
    for (int j = 0; j < std::min(kHeight, tile.y1 - y); ++j) {
      const std::size_t row =
          static_cast<std::size_t>(y + j) * static_cast<std::size_t>(image.width) +
          static_cast<std::size_t>(x);
      float depths[kWidth];
      const int width = std::min(kWidth, tile.x1 - x);
      std::fill(std::copy_n(image.depth.data() + row, width, depths), std::end(depths),
                image::kEmptyDepth);
      for (std::uint32_t rest = hidden_in_row(cover, j, depths); rest != 0; rest &= rest - 1) {
        const std::size_t pixel = row + static_cast<std::size_t>(std::countr_zero(rest));
        image.depth[pixel] = image::kEmptyDepth;
        image.colour[pixel] = {};
        ++dropped;
      }
    }
  }
  return dropped;
}

}  // namespace

OthersDepths::OthersDepths(RankContext& rank, RegionDrawing& drawing)
    : rank_(rank), drawing_(drawing) {
  if (rank.ranks() == 1 || rank.prepared.transparent || rank.in_steps ||
      rank.options.shade == Shade::immediate)
    return;
  const double before = rank.communicator.seconds();
  rank.communicator.mark(comm::Phase::redistribute, 0);
  mine_ = drawing.tiles_seen();
  pending_.emplace(rank.communicator, message_of(mine_, drawing.find_covers()), merge);
  rank.counts.phases.redistribute += rank.communicator.seconds() - before;
}

geometry::Rect OthersDepths::in_samples(const geometry::Rect& tiles) const {
  return geometry::intersection(
      {tiles.x0 * kTileSize, tiles.y0 * kTileSize, tiles.x1 * kTileSize, tiles.y1 * kTileSize},
      rank_.screen.frame());
}

geometry::Rect OthersDepths::shown() const {
  return mine_.empty() ? geometry::Rect() : in_samples(mine_);
}

geometry::Rect OthersDepths::hide() {
  if (!pending_) return rank_.screen.frame();
  const double before = rank_.communicator.seconds();
  const comm::Buffer all = pending_->finish();
  geometry::Rect seen = tiles_of(all);
  if (seen.empty()) seen = {0, 0, 1, 1};
  drawing_.hide_behind(all.as<BlockCover>().subspan(kTiles));
  rank_.communicator.mark(comm::Phase::rasterize, 0);
  rank_.counts.phases.redistribute += rank_.communicator.seconds() - before;
  return in_samples(seen);
}

std::span<const TileJob> OthersDepths::finish_meanwhile(FinishTile finish_tile,
                                                        parallel::FunctionRef<bool(int)> wanted) {
  if (!pending_) return {};
  return drawing_.finish_some(finish_tile, wanted, [&] { return !pending_->advance(); });
}

template <class Colour>
image::BasicImage<Colour> OthersDepths::end_samples_meanwhile(geometry::Rect& seen) {
  ImageOfTiles<Colour> tiles(rank_);
  image::BasicImage<Colour>& image = tiles.image();
  const auto finish_tile = [&](std::span<const geometry::Rect> rects, TileView& tile) {
    tiles.store(rects, tile);
  };
  const std::vector<std::uint8_t>& hidden = rank_.scratch.partly_hidden;
  const bool is_known = hidden.size() == static_cast<std::size_t>(rank_.screen.tiles());
  const std::span<const TileJob> early = finish_meanwhile(finish_tile, [&](int tile) {
    return is_known && hidden[static_cast<std::size_t>(tile)] == 0;
  });
  seen = hide();
  std::atomic<std::uint64_t> dropped{0};
  parallel::parallel_for(0, early.size(), 4, [&](std::size_t k) {
    const int tile = early[k].tile;
    const std::uint64_t here =
        drop_hidden(rank_.screen.tile(tile), drawing_.hidden_behind(tile), image);
    rank_.scratch.partly_hidden[static_cast<std::size_t>(tile)] = here > 0 ? 1 : 0;
    dropped += here;
  });
  if (dropped > 0) {
    drawing_.drop_samples([&](std::uint64_t pixel) {
      return image.depth[static_cast<std::size_t>(pixel)] == image::kEmptyDepth;
    });
  }
  RegionCounts done = drawing_.finish(finish_tile);
  done.fragments -= dropped;
  done.shaded -= dropped;
  rank_.count(done);
  return tiles.take();
}

template image::Image8 OthersDepths::end_samples_meanwhile(geometry::Rect&);
template image::ImageF OthersDepths::end_samples_meanwhile(geometry::Rect&);

}  // namespace delray::raster
