// Packs the tiles of a rank into one message, what each took, then colours, then depths, and copies
// them into the picture on rank 0. Degenerate: a rank without tiles sends a count of 0; tiles that
// were not rendered have no pixels.
#include "raytrace/distributed/collect_tiles.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "comm/collectives.h"
#include "loadbalance/deliver.h"

namespace delray::raytrace {
namespace {

using geometry::Rect;

TileCost cost_of(const TilePixels& tile) {
  return {tile.tile, tile.pixels, tile.rays.sent(), tile.busy};
}

// `window` is what the image shows of the frame.
void put(const Rect& tile, const image::RgbaF* colour, const float* depth, const Rect& window,
         image::ImageF& image) {
  const auto width = static_cast<std::size_t>(tile.width());
  for (int y = tile.y0; y < tile.y1; ++y) {
    const std::size_t to =
        static_cast<std::size_t>(y - window.y0) * static_cast<std::size_t>(image.width) +
        static_cast<std::size_t>(tile.x0 - window.x0);
    const std::size_t from = static_cast<std::size_t>(y - tile.y0) * width;
    std::copy_n(colour + from, width, image.colour.data() + to);
    std::copy_n(depth + from, width, image.depth.data() + to);
  }
}

// How many tiles there are, what each took, then the colours of all, then their depths.
comm::Buffer pack(std::span<const TilePixels> tiles) {
  std::size_t pixels = 0;
  for (const TilePixels& tile : tiles) pixels += tile.pixels;
  const std::uint64_t count = tiles.size();
  comm::Buffer message(sizeof(count) + tiles.size() * sizeof(TileCost) +
                       pixels * (sizeof(image::RgbaF) + sizeof(float)));
  std::memcpy(message.data(), &count, sizeof(count));
  std::byte* cost = message.data() + sizeof(count);
  std::byte* colour = cost + tiles.size() * sizeof(TileCost);
  std::byte* depth = colour + pixels * sizeof(image::RgbaF);
  for (const TilePixels& tile : tiles) {
    const TileCost took = cost_of(tile);
    const std::size_t n = tile.pixels;
    std::memcpy(cost, &took, sizeof(took));
    std::memcpy(colour, tile.own_colour.data(), n * sizeof(image::RgbaF));
    std::memcpy(depth, tile.own_depth.data(), n * sizeof(float));
    cost += sizeof(took);
    colour += n * sizeof(image::RgbaF);
    depth += n * sizeof(float);
  }
  return message;
}

void unpack(const comm::Buffer& message, const loadbalance::Blocks& tiles,
            std::vector<TileCost>& costs, image::ImageF& image) {
  std::uint64_t count = 0;
  std::memcpy(&count, message.data(), sizeof(count));
  const std::size_t first = costs.size();
  costs.resize(first + count);
  if (count == 0) return;
  const std::byte* at = message.data() + sizeof(count);
  std::memcpy(&costs[first], at, count * sizeof(TileCost));
  std::size_t pixels = 0;
  for (std::size_t i = first; i < costs.size(); ++i) {
    pixels += costs[i].pixels;
  }
  // What comes before is a multiple of 8 bytes, so both planes are aligned where they lie.
  const auto* colour = reinterpret_cast<const image::RgbaF*>(at + count * sizeof(TileCost));
  const auto* depth = reinterpret_cast<const float*>(colour + pixels);
  for (std::size_t i = first; i < costs.size(); ++i) {
    if (costs[i].pixels == 0) continue;
    const Rect tile = tiles.block(costs[i].tile);
    put(tile, colour, depth, tiles.frame, image);
    colour += tile.area();
    depth += tile.area();
  }
}

}  // namespace

std::vector<TileCost> collect_tiles(comm::Communicator& communicator,
                                    const loadbalance::Blocks& tiles,
                                    std::span<const TilePixels> mine, image::ImageF& image) {
  const bool root = communicator.rank() == 0;
  const std::vector<comm::Buffer> messages =
      comm::gather(communicator, 0, root ? comm::Buffer() : pack(mine));
  std::vector<TileCost> costs;
  if (!root) return costs;
  for (const TilePixels& tile : mine) costs.push_back(cost_of(tile));
  for (std::size_t rank = 1; rank < messages.size(); ++rank) {
    unpack(messages[rank], tiles, costs, image);
  }
  return costs;
}

void check_displays(std::span<const loadbalance::Region> displays, const Rect& window, int ranks) {
  for (const loadbalance::Region& display : displays) {
    if (display.rect.empty() || display.owner < 0 || display.owner >= ranks ||
        geometry::intersection(display.rect, window) != display.rect)
      throw std::invalid_argument("a display has pixels of the frame and a rank that shows it");
  }
}

std::vector<image::ImageF> deliver_tiles(comm::Communicator& communicator,
                                         std::span<const TilePixels> mine,
                                         std::span<const loadbalance::Region> displays) {
  std::vector<loadbalance::Pixels> pixels;
  for (const TilePixels& tile : mine) {
    if (tile.pixels == 0) continue;
    pixels.push_back(
        {tile.rect, reinterpret_cast<const std::byte*>(tile.colour), tile.depth, tile.stride});
  }
  std::vector<image::ImageF> pictures;
  std::vector<loadbalance::PixelsToSet> shown;
  for (const loadbalance::Region& display : displays) {
    if (display.owner != communicator.rank()) continue;
    image::ImageF& picture = pictures.emplace_back(display.rect.width(), display.rect.height());
    shown.push_back({display.rect, reinterpret_cast<std::byte*>(picture.colour.data()),
                     picture.depth.data(), static_cast<std::size_t>(picture.width)});
  }
  loadbalance::deliver(communicator, pixels, sizeof(image::RgbaF), displays, shown);
  return pictures;
}

std::vector<TileCost> collect_costs(comm::Communicator& communicator,
                                    std::span<const TilePixels> mine) {
  std::vector<TileCost> own, all;
  for (const TilePixels& tile : mine) own.push_back(cost_of(tile));
  for (const comm::Buffer& from :
       comm::gather(communicator, 0, comm::Buffer::of(std::span<const TileCost>(own)))) {
    const std::span<const TileCost> costs = from.as<TileCost>();
    all.insert(all.end(), costs.begin(), costs.end());
  }
  return all;
}

std::vector<RankStatistics> gather_statistics(comm::Communicator& communicator,
                                              const RankStatistics& mine) {
  // All but the timeline, which follows.
  const std::size_t timeline_bytes = mine.timeline.size() * sizeof(loadbalance::Interval);
  const RankCounts& counts = mine;
  comm::Buffer message(sizeof(counts) + timeline_bytes);
  std::memcpy(message.data(), &counts, sizeof(counts));
  if (timeline_bytes > 0) {
    std::memcpy(message.data() + sizeof(counts), mine.timeline.data(), timeline_bytes);
  }
  std::vector<RankStatistics> ranks;
  for (const comm::Buffer& from : comm::gather(communicator, 0, std::move(message))) {
    RankStatistics& rank = ranks.emplace_back();
    std::memcpy(static_cast<RankCounts*>(&rank), from.data(), sizeof(RankCounts));
    rank.timeline.resize((from.size() - sizeof(RankCounts)) / sizeof(loadbalance::Interval));
    if (rank.timeline.empty()) continue;
    std::memcpy(rank.timeline.data(), from.data() + sizeof(RankCounts),
                from.size() - sizeof(RankCounts));
  }
  return ranks;
}

}  // namespace delray::raytrace
