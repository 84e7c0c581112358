// One triangle of a cluster, whatever it is, and its entries in the tiles that it touches.
#pragma once

#include "raster/pipeline/cluster_set_up.h"

namespace delray::raster {

// Appends a part of a triangle, whose pixels lie in `box`, and its entries in the tiles that it
// touches.
inline void append_triangle(const ClusterToSetUp& cluster, const ScreenTriangle& triangle,
                            const geometry::Rect& box, SetUpResult& result) {
  const geometry::Rect pixels = geometry::intersection(box, cluster.clip);
  if (pixels.empty()) return;
  const int x0 = pixels.x0 / kTileSize, x1 = (pixels.x1 - 1) / kTileSize;
  const int y0 = pixels.y0 / kTileSize, y1 = (pixels.y1 - 1) / kTileSize;
  const bool large = (x1 - x0 + 1) * (y1 - y0 + 1) > kFewTiles;
  auto& triangles = large ? result.large_triangles : result.triangles;
  auto& entries = large ? result.large_entries : result.entries;
  const bool masked = cluster.on_screen.draw.masked;
  const auto entry = static_cast<std::uint32_t>(triangles.size()) | (masked ? kMasked : 0);
  triangles.push_back(triangle);
  const int tiles_x = cluster.on_screen.screen.tiles_x;
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x)
      entries.push_back({static_cast<std::uint32_t>(y * tiles_x + x), entry});
  }
}

// As append_triangle, of a blended draw.
inline void append_blended(const ClusterToSetUp& cluster, const ScreenTriangle& triangle,
                           const geometry::Rect& box, SetUpResult& result) {
  const geometry::Rect pixels = geometry::intersection(box, cluster.clip);
  if (pixels.empty()) return;
  const auto entry = static_cast<std::uint32_t>(result.blended_triangles.size());
  result.blended_triangles.push_back(triangle);
  const int tiles_x = cluster.on_screen.screen.tiles_x;
  for (int y = pixels.y0 / kTileSize; y <= (pixels.y1 - 1) / kTileSize; ++y) {
    for (int x = pixels.x0 / kTileSize; x <= (pixels.x1 - 1) / kTileSize; ++x)
      result.blended_entries.push_back({static_cast<std::uint32_t>(y * tiles_x + x), entry});
  }
}

// Clips, culls and appends the cluster's triangle at `place`, whatever it is, and counts what
// became of it.
inline void set_up_place(const ClusterToSetUp& cluster, std::uint32_t place, SetUpResult& result) {
  bool handed = false;
  const auto emit = [&](const ScreenTriangle& triangle, const geometry::Rect& pixels) {
    if (cluster.on_screen.draw.blended)
      append_blended(cluster, triangle, pixels, result);
    else
      append_triangle(cluster, triangle, pixels, result);
    handed |= !geometry::intersection(pixels, cluster.clip).empty();
  };
  const SetUpOutcome outcome = set_up(cluster.on_screen, place, cluster.first_number + place, emit);
  ++result.counts.in;
  result.counts.culled += outcome == SetUpOutcome::culled;
  result.counts.clipped += outcome == SetUpOutcome::clipped;
  result.counts.rasterized += handed;
}

}  // namespace delray::raster
