// Chooses the centre of the box as origin where the box reaches many of its diagonals away from 0,
// and subtracts it in double precision.
#include "scenes/geometry/origin.h"

#include <algorithm>

namespace delray::scenes::internal {

double reach_of(const geometry::Box3d& box) {
  if (box.empty()) return 0;
  const glm::dvec3 farthest = glm::max(glm::abs(box.low), glm::abs(box.high));
  return std::max({farthest.x, farthest.y, farthest.z});
}

glm::dvec3 origin_of(const geometry::Box3d& box) {
  const bool far = reach_of(box) > kFar * glm::length(box.size());
  return far ? box.centre() : glm::dvec3(0);
}

geometry::Box3d box_of(std::span<const glm::dvec3> positions) {
  geometry::Box3d box;
  for (const glm::dvec3& p : positions) box.include(p);
  return box;
}

geometry::Box3d box_of(std::span<const glm::vec3> positions) {
  geometry::Box3d box;
  for (const glm::vec3& p : positions) box.include(glm::dvec3(p));
  return box;
}

std::vector<glm::vec3> relative_to(const glm::dvec3& origin,
                                   std::span<const glm::dvec3> positions) {
  std::vector<glm::vec3> result;
  result.reserve(positions.size());
  for (const glm::dvec3& p : positions) result.emplace_back(p - origin);
  return result;
}

void make_relative_to(const glm::dvec3& origin, std::span<glm::vec3> positions) {
  if (origin == glm::dvec3(0)) return;
  for (glm::vec3& p : positions) p = glm::dvec3(p) - origin;
}

}  // namespace delray::scenes::internal
