// A cluster of triangles as fragments and triangles on the screen.
#pragma once

#include <cstdint>
#include <vector>

#include "raster/pipeline/frame_tiles.h"
#include "raster/pipeline/set_up.h"
#include "raster/pipeline/visibility.h"

namespace delray::raster {

// What a thread has set up of a few clusters, for the tiles.
struct SetUpResult {
  // Pixels of small triangles: fragment i is at pixel address[i] & (kTilePixels - 1) of tile
  // address[i] / kTilePixels, and its key is code[i] << 32 | number[i].
  std::vector<std::uint32_t> address, code, number;
  std::size_t fragments = 0;  // elements of the three that count

  WindowTriangles windows;
  bool fragments_only = false;  // instead of windows

  // Triangles that touch few tiles, and their entries; and those that touch many.
  struct Entry {
    std::uint32_t tile, entry;  // see kMasked
  };
  std::vector<ScreenTriangle> triangles, large_triangles;
  std::vector<Entry> entries, large_entries;
  // All triangles of blended draws.
  std::vector<ScreenTriangle> blended_triangles;
  std::vector<Entry> blended_entries;

  TriangleCounts counts;

  void clear() {
    fragments = 0;
    windows.size = 0;
    triangles.clear();
    entries.clear();
  }
};

// Triangles that touch more tiles than this are large.
inline constexpr int kFewTiles = 4;

// Sets up places [cluster.begin, cluster.end) of the cluster and appends what may be seen in
// `wanted` (pixels of the frame); place p has the number `first_number` + p. Counts them. Small
// triangles that are known to be hidden in `tiles` are left out, but counted.
void set_up_cluster(const Screen& screen, const PreparedDraw& draw, const ClusterBlock& block,
                    const Cluster& cluster, const ScreenVertices& vertices,
                    std::uint32_t first_number, const geometry::Rect& clip, const FrameTiles& tiles,
                    SetUpResult& result);

}  // namespace delray::raster
