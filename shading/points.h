// Blocks of sixteen points in structure-of-arrays form: what is shaded at a time.
//
// Element i of every array belongs to lane i. A renderer may leave lanes unused and say which it
// means with a mask; what the others hold makes no difference.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "shading/surface.h"

namespace delray::shading {

inline constexpr int kBlockPoints = 16;

// Bit i: lane i is meant.
using LaneMask = std::uint32_t;
inline constexpr LaneMask kAllLanes = (1U << kBlockPoints) - 1;
inline LaneMask first_lanes(int count) { return (1U << count) - 1; }

// A number a lane.
struct alignas(64) Floats16 {
  float lane[kBlockPoints] = {};
  float& operator[](int i) { return lane[i]; }
  float operator[](int i) const { return lane[i]; }
};

// Three numbers a lane: positions, directions (x, y, z) or linear RGB.
struct Vectors16 {
  Floats16 x, y, z;
  void set(int i, const glm::vec3& v) { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
  glm::vec3 get(int i) const { return {x[i], y[i], z[i]}; }
};

// Where they lie in the textures of a set, and Footprint: how that changes to the next pixel.
struct TexturePoints {
  Floats16 u, v;
  Floats16 dx_u, dx_v, dy_u, dy_v;
  void set(int i, const TexturePoint& point) {
    u[i] = point.uv.x, v[i] = point.uv.y;
    dx_u[i] = point.footprint.dx.x, dx_v[i] = point.footprint.dx.y;
    dy_u[i] = point.footprint.dy.x, dy_v[i] = point.footprint.dy.y;
  }
  TexturePoint get(int i) const { return {{u[i], v[i]}, {{dx_u[i], dx_v[i]}, {dy_u[i], dy_v[i]}}}; }
};

// What Point says of one point.
struct Points {
  Vectors16 position;
  Vectors16 geometric_normal, normal;
  Vectors16 tangent;
  Floats16 handedness;    // the tangent's w; read where normals are mapped
  TexturePoints uvs[2];   // by set; read where there is a texture of the set
  bool coloured = false;  // false: colours of vertices are not read
  Vectors16 colour;
  Floats16 colour_alpha;
};

// Lane i becomes `point`; its colour is kept only if points.coloured.
inline void set_point(Points& points, int i, const Point& point) {
  points.position.set(i, point.position);
  points.geometric_normal.set(i, point.geometric_normal);
  points.normal.set(i, point.normal);
  points.tangent.set(i, glm::vec3(point.tangent));
  points.handedness[i] = point.tangent.w;
  points.uvs[0].set(i, {point.uv, point.footprint});
  points.uvs[1].set(i, point.second);
  if (!points.coloured) return;
  points.colour.set(i, glm::vec3(point.colour));
  points.colour_alpha[i] = point.colour.w;
}

}  // namespace delray::shading
