#include "raster/internal/bins.h"

#include <algorithm>

#include "raster/internal/set_up.h"

namespace delray::raster {

void fill_bin(const Screen& screen, const DrawList& list, std::span<const PreparedDraw> draws,
              std::uint32_t begin, std::uint32_t end, std::span<const std::uint8_t> wanted,
              Bin& bin) {
  struct Entry {
    std::uint32_t tile, triangle;
  };
  static thread_local std::vector<Entry> unsorted;
  unsorted.clear();
  bin.triangles.clear();
  bin.first.clear();
  bin.entries.clear();
  bin.counts = {};

  for (std::uint32_t k = begin; k < end; ++k) {
    const Cluster& cluster = list.clusters[k];
    const PreparedDraw& draw = draws[cluster.draw];
    const std::uint32_t mark = draw.masked ? Bin::kMasked : 0;
    bin.counts.in += cluster.count;
    for (std::uint32_t i = 0; i < cluster.count; ++i) {
      const auto emit = [&](const ScreenTriangle& triangle, const geometry::Rect& pixels) {
        const auto index = static_cast<std::uint32_t>(bin.triangles.size());
        const std::size_t before = unsorted.size();
        const int last_x = (pixels.x1 - 1) / kTileSize;
        const int last_y = (pixels.y1 - 1) / kTileSize;
        for (int y = pixels.y0 / kTileSize; y <= last_y; ++y)
          for (int x = pixels.x0 / kTileSize; x <= last_x; ++x) {
            const int tile = y * screen.tiles_x + x;
            if (wanted[tile]) unsorted.push_back({static_cast<std::uint32_t>(tile), index | mark});
          }
        if (unsorted.size() > before) bin.triangles.push_back(triangle);
      };
      const std::size_t before = bin.triangles.size();
      const Fate fate = set_up(screen, draw, cluster.first + i, (k << kClusterBits) | i, emit);
      bin.counts.culled += fate == Fate::culled;
      bin.counts.clipped += fate == Fate::clipped;
      bin.counts.rasterized += bin.triangles.size() > before;
    }
  }
  if (unsorted.empty()) return;

  // Counting sort: stable, so entries of a tile stay in ascending order.
  bin.first.assign(static_cast<std::size_t>(screen.tiles()) + 1, 0);
  for (const Entry& entry : unsorted) ++bin.first[entry.tile + 1];
  for (std::size_t i = 1; i < bin.first.size(); ++i) bin.first[i] += bin.first[i - 1];
  bin.entries.resize(unsorted.size());
  static thread_local std::vector<std::uint32_t> next;
  next.assign(bin.first.begin(), bin.first.end() - 1);
  for (const Entry& entry : unsorted) bin.entries[next[entry.tile]++] = entry.triangle;
}

Extent extent(const Screen& screen, const PreparedDraw& draw, std::uint32_t first,
              std::uint32_t count) {
  Extent result;
  result.box = {screen.width, screen.height, 0, 0};
  for (std::uint32_t t = first; t < first + count; ++t)
    set_up(screen, draw, t, 0, [&](const ScreenTriangle& triangle, const geometry::Rect& pixels) {
      result.box = {std::min(result.box.x0, pixels.x0), std::min(result.box.y0, pixels.y0),
                    std::max(result.box.x1, pixels.x1), std::max(result.box.y1, pixels.y1)};
      ++result.triangles;
      const std::int64_t area =
          doubled_area(triangle.vertex[0], triangle.vertex[1], triangle.vertex[2]) >>
          (2 * kSubpixelBits + 1);
      result.pixels += std::min<std::int64_t>(area + 1, pixels.area());
    });
  if (result.triangles == 0) result.box = {};
  return result;
}

}  // namespace delray::raster
