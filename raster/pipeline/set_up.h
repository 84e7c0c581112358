// One triangle of a mesh as the triangles that it is on the screen: culled, whole, or the parts
// that clipping leaves of it.
#pragma once

#include <array>

#include "raster/pipeline/clip.h"
#include "raster/pipeline/cluster_on_screen.h"

namespace delray::raster {

// How many triangles were looked at, and what became of them.
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

// How much setting up has left of a triangle. Culled: nothing is left.
enum class SetUpOutcome : std::uint8_t { whole, clipped, culled };

// A triangle over half of the pixels: what stands for a splat where only costs are asked for.
inline ScreenTriangle half_of(const geometry::Rect& pixels, const Screen& screen,
                              std::uint32_t number) {
  const auto vertex = [&](int x, int y) {
    return ScreenVertex{(x - screen.centre_x) * kSubpixels, (y - screen.centre_y) * kSubpixels, -1};
  };
  return {
      {vertex(pixels.x0, pixels.y0), vertex(pixels.x1, pixels.y0), vertex(pixels.x0, pixels.y1)},
      number};
}

// Hands `emit(triangle, pixels)` every part of the cluster's triangle at `place` that has area and
// a box with a pixel centre of the frame in it; the parts get `number`, and positive area. Of a
// splat, half of its box.
template <class Emit>
SetUpOutcome set_up(const ClusterOnScreen& cluster, std::uint32_t place, std::uint32_t number,
                    Emit&& emit) {
  const Screen& screen = cluster.screen;
  const PreparedDraw& draw = cluster.draw;
  if (draw.splats.any()) {
    const geometry::Rect pixels =
        make_splat(screen, draw.splats, *draw.draw->mesh, cluster.cluster.first + place, number)
            .pixels;
    if (pixels.empty()) return SetUpOutcome::culled;
    emit(half_of(pixels, screen, number), pixels);
    return SetUpOutcome::whole;
  }
  const LocalCorners corners = corners_at(cluster.block, cluster.cluster, place);
  const ScreenVertex a = cluster.vertices[corners.a];
  const ScreenVertex b = cluster.vertices[corners.b];
  const ScreenVertex c = cluster.vertices[corners.c];
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
    return any ? SetUpOutcome::whole : SetUpOutcome::culled;
  }
  const scenes::Mesh& mesh = *draw.draw->mesh;
  const glm::uvec3& corner = mesh.triangles[cluster.cluster.first + place];
  const ScreenPolygon polygon =
      clip(screen,
           {draw.to_view(mesh.positions[corner.x]), draw.to_view(mesh.positions[corner.y]),
            draw.to_view(mesh.positions[corner.z])},
           {a, b, c});
  for (int i = 2; i < polygon.size; ++i)
    part(polygon.vertex[0], polygon.vertex[i - 1], polygon.vertex[i]);
  return any ? SetUpOutcome::clipped : SetUpOutcome::culled;
}

}  // namespace delray::raster
