// The camera that both renderers share.
#pragma once

#include <glm/glm.hpp>
#include <string>

#include "geometry/box.h"
#include "geometry/rect.h"

namespace delray::scenes {

// A camera with a thin lens, or a pinhole if the lens has no size, or an orthographic one, whose
// rays are parallel. `up` need not be at right angles to the view, only not parallel to it.
struct Camera {
  glm::vec3 eye{0, 0, 1};
  glm::vec3 at{0, 0, 0};
  glm::vec3 up{0, 1, 0};
  float vertical_fov = 40.0F;  // degrees, 0 < fov < 180
  float near = 0;              // distance of the near plane; 0: a small part of |at - eye|
  float aperture = 0;          // diameter of the lens, >= 0; the rasterizer sees through its centre
  float focus = 0;             // distance of what is sharp, along the view; 0: that of `at`
  // The height of an orthographic camera's frame in the world, above 0, instead of
  // fov, lens and focus; `near` may be 0, and nothing lies beyond `far` (0: twice |at - eye|).
  float height = 0, far = 0;
  std::string name = {};  // in its file

  bool orthographic() const { return height > 0; }
};

// A camera bound to a frame of pixels: the one place where pixels and directions meet.
//
// A point p is seen at view coordinates v = (dot(p - eye, right), dot(p - eye, up),
// dot(p - eye, forward)), v.z > 0 in front, and falls on the real-valued pixel position
//   x = half_width  + v.x / v.z * scale,   y = half_height - v.y / v.z * scale.
// The centre of pixel (i, j) is (i + 0.5, j + 0.5); the ray through position (x, y) has direction
//   forward + right * ((x - half_width) / scale) - up * ((y - half_height) / scale).
// In an orthographic view v.z is 1 here, and the terms added to forward are added to eye instead.
struct View {
  glm::vec3 eye, right, up, forward;  // unit vectors at right angles
  float scale = 1;                    // pixels per unit of v.x / v.z
  float half_width = 0, half_height = 0;
  float near = 0;
  int width = 0, height = 0;
  bool orthographic = false;
  float far = 0;             // of an orthographic view, above near
  glm::vec3 viewpoint;       // the eye, or if orthographic a point so far behind it that all of the
                             // scene is seen from there in one direction
  float lens_radius = 0;     // 0: a pinhole
  float focus_distance = 1;  // along `forward`

  // Through the centre of the lens, or along `forward`.
  glm::vec3 ray(float x, float y) const {  // not normalised: its part along `forward` is 1
    if (orthographic) return forward;
    return forward + right * ((x - half_width) / scale) - up * ((y - half_height) / scale);
  }

  glm::vec3 origin(float x, float y) const {  // of that ray
    if (!orthographic) return eye;
    return eye + right * ((x - half_width) / scale) - up * ((y - half_height) / scale);
  }
  // The growth of a pixel's width per unit of distance, and its width at distance 0.
  float spread() const { return orthographic ? 0.0F : 1.0F / scale; }
  float first_width() const { return orthographic ? 1.0F / scale : 0.0F; }

  // Through a point of the lens, given in the unit disc: all of them meet at the focus distance.
  // The direction's part along `forward` is 1 as well.
  struct Ray {
    glm::vec3 origin, direction;
  };
  Ray ray(float x, float y, const glm::vec2& lens) const {
    const glm::vec3 across = right * (lens.x * lens_radius) + up * (lens.y * lens_radius);
    return {origin(x, y) + across, ray(x, y) - across * (1.0F / focus_distance)};
  }
};

// REQUIRES: width, height >= 1. A camera whose eye equals `at`, or whose up is parallel to the
// view, gets some direction rather than NaN.
View make_view(const Camera& camera, int width, int height);

// The view of a part of its frame alone, in whose pixels everything falls to the same places, in
// whole numbers shifted. Of a part, half_width and half_height are where the axis is, not half its
// sides. REQUIRES: the window lies in the frame.
View cropped(const View& view, const geometry::Rect& window);

// A rectangle of pixels outside of which no ray from the lens, through any place in its pixel,
// meets a point of the box. Empty for an empty box; for one that reaches behind the eye and for a
// lens with a size it is the whole frame. Rays may be rounded as make_view's numbers and a
// thousandth of a pixel ask for.
geometry::Rect pixels_of(const View& view, const geometry::Box3& box);

}  // namespace delray::scenes
