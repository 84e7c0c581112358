// The order of points in a mesh: along Hilbert's curve through their box, so that neighbours follow
// each other, and points at one place in the order of the input.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/box.h"

namespace delray::scenes {

// Places along the curve, of which there are 2^21 along the longest side of the box.
class PointOrder {
 public:
  // REQUIRES: the box is finite.
  explicit PointOrder(const geometry::Box3& box);

  // Ascends along the curve. What is beyond the box counts as its border.
  std::uint64_t place(const glm::vec3& p) const;

 private:
  glm::dvec3 low_{0};
  double scale_ = 0;  // 0: a box without extent, of one place
};

// A place along the curve, and which point it is of.
struct PointPlace {
  std::uint64_t place;
  std::uint32_t point;
  bool operator<(const PointPlace& b) const {
    return place != b.place ? place < b.place : point < b.point;
  }
};

// All points in that order. O(n log n), parallel.
std::vector<PointPlace> order_points(std::span<const glm::vec3> points, const PointOrder& order);

// Splits sorted places into so many runs of about the same length: where the second run and those
// after it begin. Fewer where many places are equal.
std::vector<std::uint64_t> equal_runs(std::span<const std::uint64_t> sorted, std::size_t runs);

}  // namespace delray::scenes
