// One triangle of a mesh as the triangles that it is on the screen.
#pragma once

#include <array>

#include "raster/internal/bins.h"
#include "raster/internal/clip.h"

namespace delray::raster {

enum class Fate : std::uint8_t { whole, clipped, culled };

// Hands `emit(triangle, pixels)` every part of triangle `t` of the mesh that has area and a box
// with a pixel centre of the frame in it; `number` is passed on. Parts have positive area.
template <class Emit>
Fate set_up(const Screen& screen, const PreparedDraw& draw, std::uint32_t t, std::uint32_t number,
            Emit&& emit) {
  const scenes::Mesh& mesh = *draw.draw->mesh;
  const glm::uvec3& corner = mesh.triangles[t];
  const std::uint32_t first = draw.draw->first_vertex;
  const ScreenVertex& a = draw.vertices[corner.x - first];
  const ScreenVertex& b = draw.vertices[corner.y - first];
  const ScreenVertex& c = draw.vertices[corner.z - first];

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
