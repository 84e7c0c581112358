// Chooses the centre of the box as origin where the box reaches many of its diagonals away from 0,
// and subtracts it in double precision.
#include "scenes/geometry/origin.h"

#include <algorithm>

#include "parallel/grow.h"
#include "parallel/parallel_for.h"

namespace delray::scenes::internal {

constexpr std::size_t kPositionsPerBlock = 1 << 15;  // positions: tens of microseconds

double reach_of(const geometry::Box3d& box) {
  if (box.empty()) return 0;
  const glm::dvec3 farthest = glm::max(glm::abs(box.low), glm::abs(box.high));
  return std::max({farthest.x, farthest.y, farthest.z});
}

glm::dvec3 origin_of(const geometry::Box3d& box) {
  const bool far = reach_of(box) > kFar * glm::length(box.size());
  return far ? box.centre() : glm::dvec3(0);
}

template <class T>
geometry::Box3d box_of_all(std::span<const T> positions) {
  return parallel::parallel_reduce(
      0, positions.size(), kPositionsPerBlock, geometry::Box3d{},
      [&](std::size_t first, std::size_t last) {
        geometry::Box<T> box;
        for (const T& p : positions.subspan(first, last - first)) box.include(p);
        return geometry::Box3d{glm::dvec3(box.low), glm::dvec3(box.high)};
      },
      [](geometry::Box3d a, const geometry::Box3d& b) {
        a.include(b);
        return a;
      });
}

geometry::Box3d box_of(std::span<const glm::dvec3> positions) { return box_of_all(positions); }
geometry::Box3d box_of(std::span<const glm::vec3> positions) { return box_of_all(positions); }

std::vector<glm::vec3> relative_to(const glm::dvec3& origin,
                                   std::span<const glm::dvec3> positions) {
  std::vector<glm::vec3> result;
  parallel::grow(result, positions.size());
  parallel::parallel_for(0, positions.size(), kPositionsPerBlock,
                         [&](std::size_t i) { result[i] = positions[i] - origin; });
  return result;
}

void make_relative_to(const glm::dvec3& origin, std::span<glm::vec3> positions) {
  if (origin == glm::dvec3(0)) return;
  parallel::parallel_for(0, positions.size(), kPositionsPerBlock,
                         [&](std::size_t i) { positions[i] = glm::dvec3(positions[i]) - origin; });
}

}  // namespace delray::scenes::internal
