// Areas of threads: boxes with about as many points each.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "delaunay/construction/distinct_points.h"
#include "delaunay/mesh/mesh.h"
#include "geometry/box.h"

namespace delray::delaunay::internal {

namespace point_areas {

template <class Point>
void cut(std::span<const Point> points, std::span<VertexNumber> vertices, std::uint16_t first,
         std::uint16_t last, std::vector<std::uint16_t>& areas) {
  if (last - first == 1) {
    for (const VertexNumber v : vertices) areas[v] = first;
    return;
  }
  geometry::Box<Point> box;
  for (const VertexNumber v : vertices) box.include(points[v]);
  const Point size = box.empty() ? Point(0) : box.high * 0.5 - box.low * 0.5;
  int axis = 0;
  for (int k = 1; k < Point::length(); ++k) {
    if (size[k] > size[axis]) axis = k;
  }
  const auto half = static_cast<std::uint16_t>((last - first) / 2);
  const std::size_t middle = vertices.size() * half / static_cast<std::size_t>(last - first);
  std::ranges::nth_element(vertices, vertices.begin() + static_cast<std::ptrdiff_t>(middle), {},
                           [&](VertexNumber v) { return points[v][axis]; });
  cut(points, vertices.first(middle), first, static_cast<std::uint16_t>(first + half), areas);
  cut(points, vertices.subspan(middle), static_cast<std::uint16_t>(first + half), last, areas);
}

}  // namespace point_areas

// The area of each point, halved along the longest axis again and again. O(n log areas).
template <class Point>
std::vector<std::uint16_t> areas_of(std::span<const Point> points, int areas) {
  std::vector<VertexNumber> vertices(points.size());
  for (VertexNumber v = 0; v < vertices.size(); ++v) vertices[v] = v;
  std::vector<std::uint16_t> result(points.size());
  point_areas::cut<Point>(points, vertices, 0, static_cast<std::uint16_t>(areas), result);
  return result;
}

}  // namespace delray::delaunay::internal
