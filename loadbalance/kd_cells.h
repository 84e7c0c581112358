// Space cut into cells that can be put in order for every point of view.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/box.h"

namespace delray::loadbalance {

// A tree of planes at right angles to the axes (Bentley 1975), over cells that are numbered from
// left to right. A node with n cells has its n / 2 first on the lower side of its plane.
struct KdCells {
  struct Plane {
    int axis = 0;
    float at = 0;
  };
  // Depth first, lower side first: the node of cells [a, a + n) that is planes[i] has its children,
  // if they have planes, at i + 1 and i + n / 2.
  std::vector<Plane> planes;
  // low <= p < high along every axis; those at the rim reach to infinity. Every finite point is in
  // exactly one.
  std::vector<geometry::Box3> cells;
};

inline bool contains(const geometry::Box3& cell, const glm::vec3& p) {
  return glm::all(glm::lessThanEqual(cell.low, p)) && glm::all(glm::lessThan(p, cell.high));
}
// Whether some point of the closed box is in the cell; true if the box is not a number.
inline bool touches(const geometry::Box3& cell, const geometry::Box3& box) {
  return !glm::any(glm::lessThan(box.high, cell.low)) &&
         !glm::any(glm::greaterThanEqual(box.low, cell.high));
}

// Cuts space so that the boxes whose centres are in a cell have nearly an equal share of the
// weight: at each node where the weights of the centres along their longest side say so. Boxes
// whose centre is not finite do not count. Equal centres stay together, and a cell may be empty.
// O(n log n log count).
//
// REQUIRES: weights.size() == boxes.size(); count >= 1.
KdCells cut_space(std::span<const geometry::Box3> boxes, std::span<const std::uint32_t> weights,
                  int count);

// The cells as a ray from `eye` may meet them: none is met before one that comes earlier. At each
// plane the side with the eye comes first (Fuchs, Kedem and Naylor 1980). O(cells).
std::vector<int> front_to_back(const KdCells& cells, const glm::vec3& eye);

}  // namespace delray::loadbalance
