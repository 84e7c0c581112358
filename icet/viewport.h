// Where on the display something may be drawn, and the matrices that draw a part of the display.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/rect.h"
#include "icet/context.h"

namespace delray::icet {

// Part of the display that the projected bounds cover, and the range of their depths, -1 to 1.
struct Projected {
  geometry::Rect rect;  // no pixels, or less, where nothing is seen
  double near_depth = 1, far_depth = -1;
};

// Projects the convex hull of `bounds` by `clip_from_object` onto the display, cut at the near
// plane and at the display's borders. No bounds: all of the display. Coordinates that are not
// finite count for nothing. O(vertices^2).
Projected project(std::span<const glm::dvec3> bounds, const glm::dmat4& clip_from_object,
                  const geometry::Rect& display);

// The projection of `part` of the display, which may reach beyond it, times that of all of it.
glm::dmat4 projection_of(const geometry::Rect& part, const geometry::Rect& display,
                         const glm::dmat4& projection);

// Whether something that covers `contained` may be in a tile.
inline bool is_in(const geometry::Rect& contained, const geometry::Rect& tile) {
  return contained.x0 < tile.x1 && tile.x0 < contained.x1 && contained.y0 < tile.y1 &&
         tile.y0 < contained.y1 && contained.x0 <= contained.x1 && contained.y0 <= contained.y1;
}

// The tiles that this rank draws, those in `contained`. Of ranks that draw the same, one draws a
// tile: that which shows it, or else they take turns.
std::vector<int> tiles_to_draw(const Context& context, const geometry::Rect& contained);

}  // namespace delray::icet
