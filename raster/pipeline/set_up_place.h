// One triangle of a cluster, whatever it is, and its entries in the tiles that it touches.
#pragma once

#include "raster/pipeline/cluster_set_up.h"

namespace delray::raster {

inline void append_triangle(const Screen& screen, const geometry::Rect& clip,
                            const ScreenTriangle& triangle, const geometry::Rect& box, bool masked,
                            SetUpResult& result) {
  const geometry::Rect pixels = geometry::intersection(box, clip);
  if (pixels.empty()) return;
  const int x0 = pixels.x0 / kTileSize, x1 = (pixels.x1 - 1) / kTileSize;
  const int y0 = pixels.y0 / kTileSize, y1 = (pixels.y1 - 1) / kTileSize;
  const bool large = (x1 - x0 + 1) * (y1 - y0 + 1) > kFewTiles;
  auto& triangles = large ? result.large_triangles : result.triangles;
  auto& entries = large ? result.large_entries : result.entries;
  const auto entry = static_cast<std::uint32_t>(triangles.size()) | (masked ? kMasked : 0);
  triangles.push_back(triangle);
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x)
      entries.push_back({static_cast<std::uint32_t>(y * screen.tiles_x + x), entry});
  }
}

inline void append_blended(const Screen& screen, const geometry::Rect& clip,
                           const ScreenTriangle& triangle, const geometry::Rect& box,
                           SetUpResult& result) {
  const geometry::Rect pixels = geometry::intersection(box, clip);
  if (pixels.empty()) return;
  const auto entry = static_cast<std::uint32_t>(result.blended_triangles.size());
  result.blended_triangles.push_back(triangle);
  for (int y = pixels.y0 / kTileSize; y <= (pixels.y1 - 1) / kTileSize; ++y) {
    for (int x = pixels.x0 / kTileSize; x <= (pixels.x1 - 1) / kTileSize; ++x)
      result.blended_entries.push_back({static_cast<std::uint32_t>(y * screen.tiles_x + x), entry});
  }
}

// Clips and culls it too; counts what became of it.
inline void set_up_place(const Screen& screen, const PreparedDraw& draw, const ClusterBlock& block,
                         const Cluster& cluster, const ScreenVertices& vertices,
                         std::uint32_t place, std::uint32_t first_number,
                         const geometry::Rect& clip, SetUpResult& result) {
  const MeshCluster& mesh_cluster = block.clusters[cluster.part];
  bool handed = false;
  const auto emit = [&](const ScreenTriangle& triangle, const geometry::Rect& pixels) {
    if (draw.blended)
      append_blended(screen, clip, triangle, pixels, result);
    else
      append_triangle(screen, clip, triangle, pixels, draw.masked, result);
    handed |= !geometry::intersection(pixels, clip).empty();
  };
  const Fate fate = set_up(screen, draw, vertices, corners_at(block, mesh_cluster, place),
                           cluster.first + place, first_number + place, emit);
  ++result.counts.in;
  result.counts.culled += fate == Fate::culled;
  result.counts.clipped += fate == Fate::clipped;
  result.counts.rasterized += handed;
}

}  // namespace delray::raster
