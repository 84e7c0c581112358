// Where in its triangle a pixel lies, perspective-correct.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>

#include "raster/pipeline/screen_triangle.h"

namespace delray::raster {

// Shares of the three vertices at a point of the triangle: not negative, their sum is 1 but for
// rounding.
struct Weights {
  float of[3];
  float sum;  // what the planes below add up to there, for derivatives
};

// Homogeneous barycentric coordinates as planes over the screen (Olano & Greer 1997): vertex k has
// the share u_k / (u_0 + u_1 + u_2) with u_k = (a[k]*dx + b[k]*dy) + c[k], dx and dy in pixels from
// pixel (x, y). They come from the triangle as it was before clipping, so that clipping leaves no
// trace, and are positive in it.
struct Barycentrics {
  float a[3], b[3], c[3];
  int x, y;
  bool counter_clockwise;  // as seen on the screen; false without area
  // Nowhere that the triangle covers is a share off by more than 1/64 of the whole, so that they
  // need not be bounded. Not so for slivers, and surfaces seen edge-on.
  bool proper;
};

// The length of a triangle times how much nearer its nearest vertex is than its farthest, over its
// height, beyond which the rounding of its planes shows.
inline constexpr float kMostStretched = 8192;

// Whether planes of a triangle on the screen are proper. All vertices are within `reach` of the
// origin in x and in y, `area` is twice its own (both in subpixels); depths are negated.
inline bool are_proper(float nearest, float farthest, float reach, float area) {
  return nearest * (reach * reach) < farthest * area * kMostStretched;
}

// The weight of a vertex's shares: all alike in an orthographic view.
inline float weighted_depth(const Screen& screen, const ScreenVertex& vertex) {
  return screen.view.orthographic ? -1.0F : vertex.depth;
}

// From the vertices on the screen: u_k is the edge function opposite of vertex k over the distance
// of the vertex. Exact but for the rounding of the planes, so that no pixel that is covered lies
// outside.
// REQUIRES: no vertex is kOutside.
inline Barycentrics make_barycentrics(const Screen& screen,
                                      const std::array<ScreenVertex, 3>& vertices) {
  const auto& [p, q, r] = vertices;
  Barycentrics result;
  // The origin is a pixel of the frame amid the triangle: planes lose the least precision there.
  const auto amid = [](int low, int high, int centre, int begin, int end) {
    return std::clamp(((low + high) >> (kSubpixelBits + 1)) + centre, begin, end - 1);
  };
  const geometry::Rect& whole = screen.whole;
  result.x = amid(std::min({p.x, q.x, r.x}), std::max({p.x, q.x, r.x}), screen.centre_x, whole.x0,
                  whole.x1);
  result.y = amid(std::min({p.y, q.y, r.y}), std::max({p.y, q.y, r.y}), screen.centre_y, whole.y0,
                  whole.y1);
  const int from_x = (result.x - screen.centre_x) * kSubpixels + kHalfPixel;
  const int from_y = (result.y - screen.centre_y) * kSubpixels + kHalfPixel;
  // Whole numbers below 2^50: exact.
  const double x0 = p.x - from_x, x1 = q.x - from_x, x2 = r.x - from_x;
  const double y0 = p.y - from_y, y1 = q.y - from_y, y2 = r.y - from_y;
  const double c0 = x1 * y2 - x2 * y1, c1 = x2 * y0 - x0 * y2, c2 = x0 * y1 - x1 * y0;
  const double area = (c0 + c1) + c2;
  result.counter_clockwise = area < 0;
  const double sign = result.counter_clockwise ? 1 : -1;  // depths are negative
  const float depth0 = weighted_depth(screen, p), depth1 = weighted_depth(screen, q),
              depth2 = weighted_depth(screen, r);
  const double near0 = sign * depth0, near1 = sign * depth1, near2 = sign * depth2;
  const double step0 = near0 * kSubpixels, step1 = near1 * kSubpixels, step2 = near2 * kSubpixels;
  result.a[0] = static_cast<float>((y1 - y2) * step0);
  result.a[1] = static_cast<float>((y2 - y0) * step1);
  result.a[2] = static_cast<float>((y0 - y1) * step2);
  result.b[0] = static_cast<float>((x2 - x1) * step0);
  result.b[1] = static_cast<float>((x0 - x2) * step1);
  result.b[2] = static_cast<float>((x1 - x0) * step2);
  result.c[0] = static_cast<float>(c0 * near0);
  result.c[1] = static_cast<float>(c1 * near1);
  result.c[2] = static_cast<float>(c2 * near2);
  const double reach = std::max(
      {std::abs(x0), std::abs(x1), std::abs(x2), std::abs(y0), std::abs(y1), std::abs(y2)});
  result.proper =
      are_proper(-std::min({depth0, depth1, depth2}), -std::max({depth0, depth1, depth2}),
                 static_cast<float>(reach), static_cast<float>(std::abs(area)));
  return result;
}

// From the vertices in view coordinates, wherever they are. A triangle without area, or seen
// edge-on, gives planes that are finite.
inline Barycentrics make_barycentrics(const Screen& screen,
                                      const std::array<glm::vec3, 3>& vertices) {
  const scenes::View& view = screen.view;
  glm::dvec3 v[3] = {vertices[0], vertices[1], vertices[2]};
  // Seen along parallel rays, everything might as well lie in one plane.
  for (glm::dvec3& p : v) p.z = view.orthographic ? 1 : p.z;
  // The origin is a pixel of the frame amid the triangle: planes lose the least precision there. It
  // is found in pixels of the whole frame, so that it is the same pixel in every window.
  const geometry::Rect& whole = screen.whole;
  const int width = whole.width(), height = whole.height();
  const double axis_x = double{view.half_width} - whole.x0;
  const double axis_y = double{view.half_height} - whole.y0;
  double low_x = width, high_x = 0, low_y = height, high_y = 0;
  for (const glm::dvec3& p : v) {
    const bool in_front = view.orthographic || p.z >= view.near;
    const double x = p.x / p.z * view.scale + axis_x;
    const double y = axis_y - p.y / p.z * view.scale;
    low_x = in_front ? std::min(low_x, x) : 0;
    high_x = in_front ? std::max(high_x, x) : width;
    low_y = in_front ? std::min(low_y, y) : 0;
    high_y = in_front ? std::max(high_y, y) : height;
  }
  const auto amid = [](double low, double high, int size) {
    const double centre = (std::max(low, 0.0) + std::min(high, double(size))) * 0.5;
    return static_cast<int>(std::clamp(centre, 0.0, size - 1.0));
  };
  Barycentrics result;
  const int x = amid(low_x, high_x, width), y = amid(low_y, high_y, height);
  result.x = x + whole.x0;
  result.y = y + whole.y0;

  // The ray of the origin's centre, and one plane per vertex through the eye and the edge opposite.
  const double ray_x = (x + 0.5 - axis_x) / view.scale;
  const double ray_y = (axis_y - (y + 0.5)) / view.scale;
  const double step = 1.0 / view.scale;
  const double volume = glm::dot(v[0], glm::cross(v[1] - v[0], v[2] - v[0]));
  const double facing = volume < 0 ? -1.0 : 1.0;
  result.counter_clockwise = volume > 0;
  double plane[3][3], largest = 0;
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3& p = v[(k + 1) % 3];
    const glm::dvec3 normal = glm::cross(p, v[(k + 2) % 3] - p) * facing;
    plane[k][0] = normal.x * step;
    plane[k][1] = -normal.y * step;
    plane[k][2] = (normal.x * ray_x + normal.y * ray_y) + normal.z;
    for (const double coefficient : plane[k]) largest = std::max(largest, std::abs(coefficient));
  }
  const double scale = largest > 0 ? 1 / largest : 0;
  // Their sum is least where the triangle is farthest. Snapping moves a point by less than 1/256
  // of a pixel; rounding is a matter of all terms.
  const double least_sum =
      std::abs(volume) * scale /
      std::max({v[0].z, v[1].z, v[2].z, view.orthographic ? 0.0 : double{view.near}});
  result.proper = true;
  for (int k = 0; k < 3; ++k) {
    const double a = plane[k][0] * scale, b = plane[k][1] * scale, c = plane[k][2] * scale;
    result.a[k] = static_cast<float>(a);
    result.b[k] = static_cast<float>(b);
    result.c[k] = static_cast<float>(c);
    const double moved = (std::abs(a) + std::abs(b)) / kSubpixels;
    const double rounded = (std::abs(a) * width + std::abs(b) * height + std::abs(c)) * 0x1p-22;
    result.proper = result.proper && (moved + rounded) * 64 < least_sum;
  }
  return result;
}

// At the centre of pixel (x, y). A pixel that snapping moved out of the triangle gets the weights
// of a point on its border; where all is degenerate, those of the first vertex.
inline Weights weights_at(const Barycentrics& t, int x, int y) {
  const auto dx = static_cast<float>(x - t.x);
  const auto dy = static_cast<float>(y - t.y);
  float u[3];
  for (int k = 0; k < 3; ++k) u[k] = std::max((t.a[k] * dx + t.b[k] * dy) + t.c[k], 0.0F);
  const float sum = (u[0] + u[1]) + u[2];
  if (!(sum > 0)) return {{1, 0, 0}, 0};
  return {{u[0] / sum, u[1] / sum, u[2] / sum}, sum};
}

template <class Value>
Value interpolate(const Weights& w, const Value (&value)[3]) {
  return (value[0] * w.of[0] + value[1] * w.of[1]) + value[2] * w.of[2];
}

// How `value`, whose interpolated value is `here`, changes per pixel along x (slopes = t.a) or y
// (slopes = t.b). Infinite where it has no bound.
template <class Value>
Value derivative(const Weights& w, const float (&slopes)[3], const Value (&value)[3],
                 const Value& here) {
  const Value change = ((value[0] - here) * slopes[0] + (value[1] - here) * slopes[1]) +
                       (value[2] - here) * slopes[2];
  return change / w.sum;
}

// Four values of a triangle's vertices as planes over the screen, by Barycentrics: value k at a
// pixel is (a[k]*dx + (b[k]*dy + c[k])) over what the same gives for a value of 1.
struct ValuePlanes {
  float a[4], b[4], c[4];
};

inline ValuePlanes make_value_planes(const Barycentrics& t, const glm::vec4 (&values)[3]) {
  ValuePlanes planes;
  const auto weighted = [&](const float(&share)[3], float(&sums)[4]) {
    for (int k = 0; k < 4; ++k)
      sums[k] = (share[0] * values[0][k] + share[1] * values[1][k]) + share[2] * values[2][k];
  };
  weighted(t.a, planes.a);
  weighted(t.b, planes.b);
  weighted(t.c, planes.c);
  return planes;
}

// Before the division. dx and dy: as in Barycentrics.
inline glm::vec4 sums_at(const ValuePlanes& planes, float dx, float dy) {
  glm::vec4 sums;
  for (int k = 0; k < 4; ++k) sums[k] = planes.a[k] * dx + (planes.b[k] * dy + planes.c[k]);
  return sums;
}

}  // namespace delray::raster
