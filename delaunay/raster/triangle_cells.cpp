// Heights in triangles by barycentric coordinates, seen from the lowest corner.
#include "delaunay/raster/triangle_cells.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace delray::delaunay::internal {
namespace {

bool is_lower(const glm::dvec3& a, const glm::dvec3& b) {
  return a.x != b.x ? a.x < b.x : a.y < b.y;
}

glm::dvec2 in_plane(const glm::dvec3& p) { return {p.x, p.y}; }

// On the line through two places, by the coordinate in which they are farther apart.
double height_on_edge(const glm::dvec3& one, const glm::dvec3& other, const glm::dvec2& q) {
  const glm::dvec3 &a = is_lower(one, other) ? one : other, &b = is_lower(one, other) ? other : one;
  const double width = b.x - a.x, depth = b.y - a.y;
  const double part =
      std::abs(width) >= std::abs(depth) ? (q.x - a.x) / width : (q.y - a.y) / depth;
  const double height = a.z + part * (b.z - a.z);
  return std::clamp(height, std::min(a.z, b.z), std::max(a.z, b.z));
}

}  // namespace

HeightTriangle::HeightTriangle(const std::array<glm::dvec3, 3>& corners) : p_(corners) {
  const auto lowest = std::min_element(p_.begin(), p_.end(), &is_lower);
  std::rotate(p_.begin(), lowest, p_.end());
  area_ = (p_[1].x - p_[0].x) * (p_[2].y - p_[0].y) - (p_[1].y - p_[0].y) * (p_[2].x - p_[0].x);
  std::tie(low_, high_) = std::minmax({p_[0].z, p_[1].z, p_[2].z});
}

bool HeightTriangle::contains(const glm::dvec2& q) const {
  return orient2d(in_plane(p_[0]), in_plane(p_[1]), q) >= 0 &&
         orient2d(in_plane(p_[1]), in_plane(p_[2]), q) >= 0 &&
         orient2d(in_plane(p_[2]), in_plane(p_[0]), q) >= 0;
}

double HeightTriangle::height(const glm::dvec2& q) const {
  for (const glm::dvec3& corner : p_) {
    if (corner.x == q.x && corner.y == q.y) return corner.z;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 &a = p_[i], &b = p_[(i + 1) % 3];
    if (orient2d(in_plane(a), in_plane(b), q) == 0) return height_on_edge(a, b, q);
  }
  return height_within(q);
}

double HeightTriangle::height_within(const glm::dvec2& q) const {
  const double x = q.x - p_[0].x, y = q.y - p_[0].y;
  const double second = (x * (p_[2].y - p_[0].y) - y * (p_[2].x - p_[0].x)) / area_;
  const double third = ((p_[1].x - p_[0].x) * y - (p_[1].y - p_[0].y) * x) / area_;
  const double height = p_[0].z + second * (p_[1].z - p_[0].z) + third * (p_[2].z - p_[0].z);
  // The area of a sliver may be rounded to nothing: then any height between is as good.
  return height >= low_ ? std::min(height, high_) : low_;
}

}  // namespace delray::delaunay::internal
