// A cluster of triangles as fragments and triangles on the screen.
#pragma once

#include <cstdint>
#include <vector>

#include "raster/pipeline/frame_tiles.h"
#include "raster/pipeline/set_up.h"
#include "raster/pipeline/window_spots.h"

namespace delray::raster {

// Fragments and triangles that a thread has set up of a few clusters, for the tiles.
struct SetUpResult {
  // Pixels of small triangles: fragment i is at pixel address[i] & (kTilePixels - 1) of tile
  // address[i] / kTilePixels, and its key is code[i] << 32 | number[i].
  std::vector<std::uint32_t> address, code, number;
  std::size_t fragments = 0;  // elements of the three that count

  WindowTriangles windows;
  WindowSpots spots;
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
  // Points and segments of more than a few pixels.
  std::vector<Splat> splats;
  std::vector<Entry> splat_entries;

  TriangleCounts counts;

  void clear() {
    fragments = 0;
    windows.size = 0;
    spots.size = 0;
    triangles.clear();
    entries.clear();
    splats.clear();
    splat_entries.clear();
  }
};

// Triangles that touch more tiles than this are large.
inline constexpr int kFewTiles = 4;

// Triangles of a cluster that are set up together.
struct ClusterToSetUp {
  ClusterOnScreen on_screen;
  std::uint32_t begin, end;    // places [begin, end) of the cluster
  std::uint32_t first_number;  // the triangle at place p has the number first_number + p
  geometry::Rect clip;         // pixels of the frame that are wanted
};

// Sets up the cluster's triangles, appends what may be seen within `clip`, and counts them. Small
// triangles that are known to be hidden in `tiles` are left out, but counted.
void set_up_cluster(const ClusterToSetUp& cluster, const FrameTiles& tiles, SetUpResult& result);

}  // namespace delray::raster
