// Reduces the codes of depths of blocks over all ranks.
//
// A rank that is done before others finishes tiles meanwhile, with all that it has drawn in them.
// When the others' depths are known what they hide is emptied again, so that images, counts and
// samples are what they would be if it had waited.
#include "raster/distribute/others_depths.h"

#include <algorithm>
#include <array>
#include <atomic>

#include "parallel/parallel_for.h"

namespace delray::raster {
namespace {

// Empties what lies behind the codes of blocks in a tile that was finished before they were known.
// Returns how many pixels.
template <class Colour>
std::uint64_t drop_hidden(const geometry::Rect& tile, std::span<const std::int32_t> codes,
                          image::BasicImage<Colour>& image) {
  std::uint64_t dropped = 0;
  for (int y = tile.y0; y < tile.y1; ++y) {
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width);
    const int blocks = (y - tile.y0) / VisibilityTile::kBlockHeight * VisibilityTile::kBlocksX;
    for (int x = tile.x0; x < tile.x1; ++x) {
      const std::int32_t code = codes[blocks + (x - tile.x0) / VisibilityTile::kBlockWidth];
      float& depth = image.depth[row + static_cast<std::size_t>(x)];
      if (code == kEmptyCode || depth == image::kEmptyDepth || code_of_depth(depth) <= code)
        continue;
      depth = image::kEmptyDepth;
      image.colour[row + static_cast<std::size_t>(x)] = {};
      ++dropped;
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
  std::vector<std::int32_t> least = drawing.farthest_of_blocks();
  mine_ = drawing.tiles_seen();
  least.insert(least.end(), {mine_.x0, mine_.y0, -mine_.x1, -mine_.y1});
  pending_.emplace(rank.communicator, comm::Buffer::of(std::span<const std::int32_t>(least)),
                   comm::elementwise<std::int32_t>(
                       [](std::int32_t a, std::int32_t b) { return std::min(a, b); }));
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
  const std::span<const std::int32_t> least = all.as<std::int32_t>();
  const auto [x0, y0, x1, y1] = [&] {
    const auto last = least.last<4>();
    return std::array{last[0], last[1], -last[2], -last[3]};
  }();
  geometry::Rect seen{x0, y0, x1, y1};
  if (seen.empty()) seen = {0, 0, 1, 1};
  drawing_.hide_behind({least.begin(), least.end() - 4});
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
  const RenderOptions& options = rank_.options;
  auto image = rank_.take_image<Colour>(options.width, options.height);
  const Window<Colour> window = window_of(image);
  const auto finish_tile = [&](std::span<const geometry::Rect> rects, TileView& tile) {
    for (const geometry::Rect& rect : rects) tile.shade(rect, window);
  };
  const std::vector<std::uint8_t>& hidden = rank_.scratch.partly_hidden;
  const bool is_known = hidden.size() == static_cast<std::size_t>(rank_.screen.tiles());
  const std::span<const TileJob> early = finish_meanwhile(finish_tile, [&](int tile) {
    return is_known && hidden[static_cast<std::size_t>(tile)] == 0;
  });
  seen = hide();
  std::atomic<std::uint64_t> dropped{0};
  parallel::parallel_for(0, early.size(), 4, [&](std::size_t k) {
    constexpr std::size_t kBlocks = VisibilityTile::kBlocks;
    const auto tile = static_cast<std::size_t>(early[k].tile);
    const std::uint64_t here =
        drop_hidden(rank_.screen.tile(early[k].tile),
                    drawing_.hidden_behind().subspan(tile * kBlocks, kBlocks), image);
    rank_.scratch.partly_hidden[tile] = here > 0 ? 1 : 0;
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
  return image;
}

template image::Image8 OthersDepths::end_samples_meanwhile(geometry::Rect&);
template image::ImageF OthersDepths::end_samples_meanwhile(geometry::Rect&);

}  // namespace delray::raster
