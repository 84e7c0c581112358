// Clips a triangle at the near plane and the guard band, plane by plane (Sutherland & Hodgman
// 1974), in double precision.
//
// An edge is cut from its inner end to its outer one, so that both triangles at the edge compute
// the same point. Vertices that were inside keep their snapped position. Five planes, O(1).
//
// Degenerate: a coordinate that is not finite gives nothing, as do fewer than three corners.
#include "raster/pipeline/clip.h"

#include <algorithm>
#include <cmath>

#include "raster/pipeline/transform.h"

namespace delray::raster {
namespace {

struct Vertex {
  glm::dvec3 view;
  ScreenVertex screen;  // valid unless screen.x is kOutside
};

constexpr int kPlanes = 5;

// Positive inside plane k: near, then left, right, top and bottom of the guard band.
double distance(const Screen& screen, int plane, const glm::dvec3& v) {
  const double scale = screen.view.scale, w = screen.view.orthographic ? 1 : v.z;
  const double offset_x = double{screen.offset_x} / kSubpixels;
  const double offset_y = double{screen.offset_y} / kSubpixels;
  switch (plane) {
    case 0:
      return v.z - screen.view.near;
    case 1:
      return v.x * scale + w * (kGuardPixels + offset_x);
    case 2:
      return w * (kGuardPixels - offset_x) - v.x * scale;
    case 3:
      return w * (kGuardPixels + offset_y) - v.y * scale;
    default:
      return v.y * scale + w * (kGuardPixels - offset_y);
  }
}

int to_subpixels(double position) {
  constexpr double kLimit = kGuardSubpixels;
  return static_cast<int>(std::nearbyint(std::clamp(position * kSubpixels, -kLimit, kLimit)));
}

ScreenVertex project(const Screen& screen, const glm::dvec3& v) {
  const scenes::View& view = screen.view;
  const double scale = view.scale, near = view.near, far = view.far;
  const double z = std::max(v.z, near), w = view.orthographic ? 1 : z;
  ScreenVertex result;
  result.x = to_subpixels(v.x / w * scale + double{screen.offset_x} / kSubpixels);
  result.y = to_subpixels(double{screen.offset_y} / kSubpixels - v.y / w * scale);
  const double depth = view.orthographic ? (z - far) / (far - near) : -near / z;
  result.depth = std::min(static_cast<float>(depth), kDeepest);
  return result;
}

}  // namespace

ScreenPolygon clip(const Screen& screen, const std::array<glm::vec3, 3>& view,
                   const std::array<ScreenVertex, 3>& screen_vertex) {
  std::array<Vertex, 8> polygon, next;
  int size = 3;
  for (int i = 0; i < 3; ++i) {
    const glm::vec3& v = view[i];
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) return {};
    polygon[i] = {glm::dvec3(v), screen_vertex[i]};
  }

  for (int plane = 0; plane < kPlanes && size > 0; ++plane) {
    // A vertex that transform found inside stays inside whatever the last bit says here.
    const auto distance_to = [&](const Vertex& v) {
      const double d = distance(screen, plane, v.view);
      return v.screen.x == kOutside ? d : std::max(d, 0.0);
    };
    int kept = 0;
    for (int i = 0; i < size; ++i) {
      const Vertex& from = polygon[i];
      const Vertex& to = polygon[i + 1 == size ? 0 : i + 1];
      const double d_from = distance_to(from);
      const double d_to = distance_to(to);
      if (d_from >= 0) next[kept++] = from;
      if ((d_from >= 0) != (d_to >= 0)) {
        // Always from the inner end to the outer: the neighbour runs along this edge the other way.
        const Vertex& inner = d_from >= 0 ? from : to;
        const Vertex& outer = d_from >= 0 ? to : from;
        const double d_inner = std::max(d_from, d_to);
        const double d_outer = std::min(d_from, d_to);
        const double t = d_inner / (d_inner - d_outer);
        next[kept++] = {inner.view + (outer.view - inner.view) * t, {kOutside, 0, 0}};
      }
    }
    polygon = next;
    size = kept;
  }

  ScreenPolygon result;
  result.size = size >= 3 ? size : 0;
  for (int i = 0; i < result.size; ++i) {
    result.vertex[i] =
        polygon[i].screen.x == kOutside ? project(screen, polygon[i].view) : polygon[i].screen;
  }
  return result;
}

}  // namespace delray::raster
