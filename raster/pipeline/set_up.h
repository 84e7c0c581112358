// One triangle of a mesh as the triangles that it is on the screen.
#pragma once

#include <array>

#include "raster/pipeline/clip.h"
#include "raster/pipeline/prepared_draw.h"

namespace delray::raster {

// What became of the triangles that were looked at.
struct TriangleCounts {
  std::uint64_t in = 0;
  std::uint64_t culled = 0;   // off the screen, between pixel centres, without area, or facing away
  std::uint64_t clipped = 0;  // cut by the near plane or the guard band, and something was left
  std::uint64_t rasterized = 0;       // handed to at least one tile
  std::uint64_t hidden = 0;           // of clusters behind what was drawn before
  std::uint64_t hidden_clusters = 0;  // how many these are depends on which thread was faster

  void operator+=(const TriangleCounts& other) {
    in += other.in;
    culled += other.culled;
    clipped += other.clipped;
    rasterized += other.rasterized;
    hidden += other.hidden;
    hidden_clusters += other.hidden_clusters;
  }
};

// A triangle of a cluster: numbers of its corners within the cluster.
struct LocalCorners {
  std::uint32_t a, b, c;
};
inline LocalCorners corners_at(const ClusterBlock& block, const MeshCluster& cluster,
                               std::uint32_t place) {
  const std::uint8_t* corners = block.corners.data() + cluster.first_corner + place;
  const std::uint32_t stride = cluster.corner_stride();
  return {corners[0], corners[stride], corners[std::size_t{2} * stride]};
}

enum class Fate : std::uint8_t { whole, clipped, culled };

// Hands `emit(triangle, pixels)` every part of the triangle that has area and a box with a pixel
// centre of the frame in it; `number` is passed on. Parts have positive area. The triangle is
// number `t` of the mesh, and has `corners` among `vertices`.
template <class Emit>
Fate set_up(const Screen& screen, const PreparedDraw& draw, const ScreenVertices& vertices,
            const LocalCorners& corners, std::uint32_t t, std::uint32_t number, Emit&& emit) {
  const ScreenVertex a = vertices[corners.a], b = vertices[corners.b], c = vertices[corners.c];
  bool any = false;
  const auto part = [&](const ScreenVertex& p, const ScreenVertex& q, const ScreenVertex& r) {
    const geometry::Rect pixels = centres_in_box(p, q, r, screen);
    if (pixels.empty()) return;
    const std::int64_t area = doubled_area(p, q, r);
    const int side = (area > 0) - (area < 0);
    if (side == 0 || side == draw.hidden_side) return;
    any = true;
    emit(area > 0 ? ScreenTriangle{{p, q, r}, number} : ScreenTriangle{{p, r, q}, number}, pixels);
  };

  if (a.x != kOutside && b.x != kOutside && c.x != kOutside) {
    part(a, b, c);
    return any ? Fate::whole : Fate::culled;
  }
  const scenes::Mesh& mesh = *draw.draw->mesh;
  const glm::uvec3& corner = mesh.triangles[t];
  const ScreenPolygon polygon =
      clip(screen,
           {draw.to_view(mesh.positions[corner.x]), draw.to_view(mesh.positions[corner.y]),
            draw.to_view(mesh.positions[corner.z])},
           {a, b, c});
  for (int i = 2; i < polygon.size; ++i)
    part(polygon.vertex[0], polygon.vertex[i - 1], polygon.vertex[i]);
  return any ? Fate::clipped : Fate::culled;
}

}  // namespace delray::raster
