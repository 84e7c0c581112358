#include "scenes/internal/polygon.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace delray::scenes::internal {
namespace {

constexpr std::size_t kMostCorners = 4096;

// The corners in the plane of the two axes in which the polygon is largest, counter-clockwise.
std::vector<glm::dvec2> flatten(std::span<const std::uint32_t> corners,
                                std::span<const glm::vec3> positions) {
  const glm::dvec3 origin(positions[corners[0]]);
  const auto corner = [&](std::size_t i) {
    return glm::dvec3(positions[corners[i % corners.size()]]) - origin;
  };
  glm::dvec3 normal(0);  // Newell's: the sum over the edges
  for (std::size_t i = 0; i < corners.size(); ++i) normal += glm::cross(corner(i), corner(i + 1));
  int axis = 2;
  for (const int k : {0, 1}) {
    if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
  }
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  std::vector<glm::dvec2> flat;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 p = corner(i);
    flat.push_back(normal[axis] < 0 ? glm::dvec2(p[v], p[u]) : glm::dvec2(p[u], p[v]));
  }
  return flat;
}

double turn_at(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool is_convex(const std::vector<glm::dvec2>& flat) {
  const std::size_t n = flat.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (!(turn_at(flat[i], flat[(i + 1) % n], flat[(i + 2) % n]) >= 0)) return false;
  }
  return true;
}

// True if the triangle at ring[i] holds no other corner of the ring.
bool is_ear(const std::vector<std::uint32_t>& ring, std::size_t i,
            const std::vector<glm::dvec2>& flat) {
  const std::size_t n = ring.size();
  const glm::dvec2 a = flat[ring[(i + n - 1) % n]], b = flat[ring[i]], c = flat[ring[(i + 1) % n]];
  if (!(turn_at(a, b, c) > 0)) return false;
  for (std::size_t k = 2; k + 1 < n; ++k) {
    const glm::dvec2 p = flat[ring[(i + k) % n]];
    if (p == a || p == b || p == c) continue;
    if (turn_at(a, b, p) >= 0 && turn_at(b, c, p) >= 0 && turn_at(c, a, p) >= 0) return false;
  }
  return true;
}

}  // namespace

void triangulate_polygon(std::span<const std::uint32_t> corners,
                         std::span<const glm::vec3> positions, std::vector<glm::uvec3>& triangles) {
  const std::size_t n = corners.size();
  if (n < 3) return;
  const std::vector<glm::dvec2> flat =
      n == 3 ? std::vector<glm::dvec2>{} : flatten(corners, positions);
  if (n == 3 || n > kMostCorners || is_convex(flat)) {
    for (std::size_t i = 1; i + 1 < n; ++i) {
      triangles.emplace_back(corners[0], corners[i], corners[i + 1]);
    }
    return;
  }
  std::vector<std::uint32_t> ring(n);  // what is left, as places in `corners`
  std::iota(ring.begin(), ring.end(), 0U);
  std::size_t at = 1;
  while (ring.size() > 3) {
    for (std::size_t tried = 0; tried < ring.size() && !is_ear(ring, at, flat); ++tried) {
      at = (at + 1) % ring.size();
    }
    const std::size_t size = ring.size();
    triangles.emplace_back(corners[ring[(at + size - 1) % size]], corners[ring[at]],
                           corners[ring[(at + 1) % size]]);
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(at));
    if (at >= ring.size()) at = 0;
  }
  triangles.emplace_back(corners[ring[0]], corners[ring[1]], corners[ring[2]]);
}

}  // namespace delray::scenes::internal
