// Clipping at the near plane and the guard band, for set_up() (set_up.h) where a vertex of a
// triangle is outside.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "raster/pipeline/screen_triangle.h"

namespace delray::raster {

// A convex polygon on the screen: a triangle cut by five planes has at most eight corners.
struct ScreenPolygon {
  std::array<ScreenVertex, 8> vertex;
  int size = 0;  // 0 where nothing is left
};

// The part that is left of a triangle of which at least one vertex is kOutside (Sutherland &
// Hodgman 1974). `view` are the vertices in view coordinates, `screen_vertex` what transform made
// of them. Vertices that were inside keep their position, and the point where an edge is cut
// depends on nothing but the edge, so that neighbours still meet without a gap. Empty when a
// coordinate is not finite.
ScreenPolygon clip(const Screen& screen, const std::array<glm::vec3, 3>& view,
                   const std::array<ScreenVertex, 3>& screen_vertex);

}  // namespace delray::raster
