// Counts, per pixel, the triangles that cover it: by the rasterizer and by definition.
#pragma once

#include <vector>

#include "raster/pipeline/prepared_draw.h"
#include "raster/pipeline/set_up.h"
#include "raster/pipeline/visibility.h"

namespace delray::raster {

inline scenes::View plain_view(int width, int height) {
  scenes::View view;
  view.right = {1, 0, 0};
  view.up = {0, 1, 0};
  view.forward = {0, 0, -1};
  view.eye = {0, 0, 0};
  view.scale = static_cast<float>(height);
  view.half_width = 0.5F * static_cast<float>(width);
  view.half_height = 0.5F * static_cast<float>(height);
  view.near = 0.01F;
  view.width = width;
  view.height = height;
  return view;
}

// Adds 1 to every pixel (row-major) that the rasterizer gives to the triangle.
inline void count(const Screen& screen, const ScreenTriangle& triangle, std::vector<int>& pixels) {
  static VisibilityTile tile;
  const std::uint32_t entry = 0;
  for (int k = 0; k < screen.tiles(); ++k) {
    const geometry::Rect rect = screen.tile(k);
    tile.clear(rect);
    rasterize(screen, rect, {&triangle, 1}, {&entry, 1}, tile);
    for (int y = rect.y0; y < rect.y1; ++y) {
      for (int x = rect.x0; x < rect.x1; ++x) {
        pixels[y * screen.width + x] +=
            number_of(tile.key[(y - rect.y0) * kTileSize + x - rect.x0]) != kNothing;
      }
    }
  }
}

// The centre of a pixel is covered if the point a little to the right of it, and by still less
// below it, is strictly inside: then every point of the plane belongs to one of two neighbours.
inline bool covered_by_definition(const ScreenTriangle& t, const Screen& screen, int x, int y) {
  const __int128 px = (x - screen.centre_x) * kSubpixels + kHalfPixel;
  const __int128 py = (y - screen.centre_y) * kSubpixels + kHalfPixel;
  for (int k = 0; k < 3; ++k) {
    const ScreenVertex& p = t.vertex[k];
    const ScreenVertex& q = t.vertex[(k + 1) % 3];
    const __int128 dx = q.x - p.x, dy = q.y - p.y;
    const __int128 value = dx * (py - p.y) - dy * (px - p.x);
    const __int128 decides = value != 0 ? value : dy != 0 ? -dy : dx;
    if (decides <= 0) return false;
  }
  return true;
}

// A list of all of a mesh at its place, prepared; addresses stay valid as long as it lives.
struct PreparedMesh {
  PreparedMesh(const Screen& screen, const scenes::Mesh& mesh)
      : list(make_draw_list(
            {{&mesh, &identity, 0, static_cast<std::uint32_t>(mesh.triangles.size()), 0}})) {
    draw.draw = list.draws.data();
    draw.to_view = to_view(screen.view, identity);
  }
  PreparedMesh(const PreparedMesh&) = delete;

  const glm::mat4x3 identity{1.0F};
  const DrawList list;
  PreparedDraw draw;
};

// All parts of all triangles of a mesh, one after the other, through transform, clipping and setup.
struct SetUpMesh {
  std::vector<ScreenTriangle> triangles;
  TriangleCounts counts;
};
inline SetUpMesh set_up_mesh(const Screen& screen, const scenes::Mesh& mesh, int hidden_side = 0) {
  PreparedMesh prepared(screen, mesh);
  prepared.draw.hidden_side = hidden_side;
  SetUpMesh result;
  ScreenVertices vertices;
  for (std::uint32_t k = 0; k < prepared.list.clusters.size(); ++k) {
    const Cluster& cluster = prepared.list.clusters[k];
    const ClusterBlock& block = prepared.list.block_of(cluster);
    const MeshCluster& mesh_cluster = block.clusters[cluster.part];
    transform(prepared.draw.to_view, screen, mesh.positions, block.vertices_of(mesh_cluster),
              vertices);
    for (std::uint32_t place = cluster.begin; place < cluster.end; ++place) {
      const SetUpOutcome outcome = set_up(
          {screen, prepared.draw, block, mesh_cluster, vertices}, place, k << kClusterBits | place,
          [&](const ScreenTriangle& triangle, const geometry::Rect&) {
            result.triangles.push_back(triangle);
          });
      ++result.counts.in;
      result.counts.culled += outcome == SetUpOutcome::culled;
      result.counts.clipped += outcome == SetUpOutcome::clipped;
      result.counts.rasterized += outcome != SetUpOutcome::culled;
    }
  }
  return result;
}

}  // namespace delray::raster
