// Sort-last with the scheme `tiles`: an image is composited while the rest of it is still shaded.
#include <algorithm>
#include <atomic>
#include <vector>

#include "composite/codec.h"
#include "composite/tiles.h"
#include "parallel/arena.h"
#include "raster/distribute/rank_context.h"
#include "raster/pipeline/samples.h"

namespace delray::raster {
namespace {

// Between two looks at what is finished, so that threads seldom wait for the last of them.
constexpr int kTilesOfThread = 8;

// Which of the compositor's tiles, runs of pixels, are finished when rows of the screen's are.
class TilesToHandOver {
 public:
  TilesToHandOver(const RankContext& rank, composite::TileCompositor& compositor)
      : rank_(rank),
        compositor_(compositor),
        has_something_(static_cast<std::size_t>(rank.screen.tiles())),
        finished_(static_cast<std::size_t>(rank.screen.tiles_y)),
        handed_over_(static_cast<std::size_t>(compositor.tiles())) {}

  // Any thread's.
  void has_something(const geometry::Rect& rect) { has_something_[tile_at(rect.x0, rect.y0)] = 1; }

  void rows_finished(int begin, int end) {
    std::fill(finished_.begin() + begin, finished_.begin() + end, true);
    // Each rank begins elsewhere, so that not all of them send to one.
    for (int i = 0; i < compositor_.tiles(); ++i) {
      const int tile = (first_ + i) % compositor_.tiles();
      if (handed_over_[static_cast<std::size_t>(tile)]) continue;
      const geometry::Rect samples = rect_around(compositor_.range(tile));
      if (!is_finished(samples)) continue;
      handed_over_[static_cast<std::size_t>(tile)] = true;
      if (has_something_in(samples)) {
        compositor_.drawn(tile);
      } else {
        compositor_.nothing_in(tile);
      }
    }
  }

 private:
  std::size_t tile_at(int x, int y) const {
    return static_cast<std::size_t>(y / kTileSize * rank_.screen.tiles_x + x / kTileSize);
  }

  // In samples of the screen.
  geometry::Rect rect_around(composite::PixelRange range) const {
    if (range.size() == 0) return {};
    const auto samples = static_cast<std::uint64_t>(rank_.samples_per_pixel());
    const std::uint64_t first = range.begin / samples, last = (range.end - 1) / samples;
    const auto width = static_cast<std::uint64_t>(rank_.options.width);
    geometry::Rect pixels{0, static_cast<int>(first / width), rank_.options.width,
                          static_cast<int>(last / width) + 1};
    if (pixels.height() == 1) {
      pixels.x0 = static_cast<int>(first % width);
      pixels.x1 = static_cast<int>(last % width) + 1;
    }
    return samples_of(pixels, rank_.options.supersampling);
  }
  bool is_finished(const geometry::Rect& rect) const {
    if (rect.empty()) return true;
    return std::all_of(finished_.begin() + rect.y0 / kTileSize,
                       finished_.begin() + (rect.y1 - 1) / kTileSize + 1,
                       [](bool finished) { return finished; });
  }
  bool has_something_in(const geometry::Rect& rect) const {
    for (int y = rect.y0; y < rect.y1; y = (y / kTileSize + 1) * kTileSize) {
      for (int x = rect.x0; x < rect.x1; x = (x / kTileSize + 1) * kTileSize)
        if (has_something_[tile_at(x, y)] != 0) return true;
    }
    return false;
  }

  const RankContext& rank_;
  composite::TileCompositor& compositor_;
  const int first_ = rank_.number() * (compositor_.tiles() / rank_.ranks());
  std::vector<std::uint8_t> has_something_;  // by tile of the screen
  std::vector<bool> finished_;               // by row of such tiles
  std::vector<bool> handed_over_;            // by tile of the compositor
};

}  // namespace

template <class Colour>
composite::OwnedPixels hand_over_tiles(RankContext& rank, RegionDrawing& drawing) {
  const int n = rank.options.supersampling;
  std::unique_ptr<composite::Layer> layer =
      composite::find_codec(rank.options.codec)
          ->make(rank.take_image<Colour>(rank.options.width * n * n, rank.options.height));
  auto& image = dynamic_cast<composite::ImageLayer<Colour>&>(*layer).image();
  composite::TileCompositor compositor(rank.communicator, std::move(layer),
                                       {.samples_per_pixel = n * n});
  TilesToHandOver tiles(rank, compositor);
  const int rows =
      (kTilesOfThread * parallel::arena_threads() + rank.screen.tiles_x - 1) / rank.screen.tiles_x;
  const int first =
      static_cast<int>(std::int64_t{rank.screen.tiles_y} * rank.number() / rank.ranks());
  double& seconds = rank.counts.phases.compose;
  rank.end_rows(
      drawing, first, rows,
      [&](std::span<const geometry::Rect> rects, TileView& tile) {
        store_samples(rects, tile, n, image);
        if (!tile.empty()) tiles.has_something(rects.front());
      },
      [&](int begin, int end) {
        timed(rank.communicator, seconds, [&] { return tiles.rows_finished(begin, end), 0; });
        rank.communicator.mark(comm::Phase::rasterize, 0);
      });
  return timed(rank.communicator, seconds, [&] { return compositor.finish(); });
}

template composite::OwnedPixels hand_over_tiles<image::Rgba8>(RankContext&, RegionDrawing&);
template composite::OwnedPixels hand_over_tiles<image::RgbaF>(RankContext&, RegionDrawing&);

}  // namespace delray::raster
