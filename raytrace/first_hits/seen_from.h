// What all triangles of a space have in common where they are looked for in a window.
#pragma once

#include "geometry/rect.h"
#include "raytrace/first_hits/ray_space.h"

namespace delray::raytrace {

struct SeenFrom {
  const RaySpace& space;
  glm::vec3
      planes[5];  // unit vectors out of the window's frustum: left, right, top, bottom, behind
  float scale, half_width, half_height;  // of the view
  float margin;                          // pixels: rays that are rounded
  // Rays at risk around a place x are those of pixels x - first, rounded up, to x + last, rounded
  // down.
  float first, last;
  float x0, y0, x1, y1;  // the window's first and last pixels
  geometry::Rect window;
};

}  // namespace delray::raytrace
