// A grid of square cells over a set of points, numbered along Morton's Z curve.
//
// Splitting a range of points in the order of their cell numbers where the highest bit that differs
// changes cuts it by a line parallel to an axis: cells are found by monotone operations, so all
// points on one side have the smaller coordinate.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "geometry/box.h"

namespace delray::delaunay::internal {

using Box2d = geometry::Box<glm::dvec2>;

inline Box2d box_of(std::span<const glm::dvec2> points) {
  Box2d box;
  for (const glm::dvec2& p : points) box.include(p);
  return box;
}

class CellGrid {
 public:
  // 2^16 cells along the longer side of the box. REQUIRES: the box is finite and not empty.
  explicit CellGrid(const Box2d& box) {
    const glm::dvec2 size = box.high - box.low;
    const double width = size.x > size.y ? size.x : size.y;
    // Neither the width nor its reciprocal may overflow.
    if (width > 0x1p+1000) before_ = 0x1p-8;
    if (width > 0 && width < 0x1p-900) before_ = 0x1p+600;
    low_ = box.low * before_;
    const glm::dvec2 scaled = box.high * before_ - low_;
    const double scaled_width = scaled.x > scaled.y ? scaled.x : scaled.y;
    if (scaled_width > 0) scale_ = kCellsAcross / scaled_width;
  }

  // Bits of x and y in turn, y above x. REQUIRES: p is in the box.
  std::uint32_t number(const glm::dvec2& p) const {
    std::uint64_t both = column(p) | std::uint64_t{row(p)} << 32;
    both = (both | both << 8) & 0x00ff00ff00ff00ffU;
    both = (both | both << 4) & 0x0f0f0f0f0f0f0f0fU;
    both = (both | both << 2) & 0x3333333333333333U;
    both = (both | both << 1) & 0x5555555555555555U;
    return static_cast<std::uint32_t>(both | both >> 31);
  }

  // The cells that have the first 2 * bits bits of their numbers in common are a square, and the
  // squares are numbered by rows, which is faster. REQUIRES: p is in the box; bits <= 16.
  std::uint32_t square(const glm::dvec2& p, int bits) const {
    return row(p) >> (16 - bits) << bits | column(p) >> (16 - bits);
  }
  // The square whose cells' numbers start with the 2 * bits bits of `place`.
  static std::uint32_t square_at(std::uint32_t place, int bits) {
    std::uint32_t row = 0, column = 0;
    for (int bit = 0; bit < bits; ++bit) {
      column |= (place >> 2 * bit & 1) << bit;
      row |= (place >> (2 * bit + 1) & 1) << bit;
    }
    return row << bits | column;
  }

 private:
  std::uint32_t column(const glm::dvec2& p) const {
    return static_cast<std::uint32_t>(static_cast<std::int32_t>((p.x * before_ - low_.x) * scale_));
  }
  std::uint32_t row(const glm::dvec2& p) const {
    return static_cast<std::uint32_t>(static_cast<std::int32_t>((p.y * before_ - low_.y) * scale_));
  }

  // Less than 2^16 by more than rounding can add.
  static constexpr double kCellsAcross = 65535.5;

  double before_ = 1;
  glm::dvec2 low_{0};
  double scale_ = 0;
};

// Whether the highest bit in which two different cell numbers differ is one of y.
inline bool split_by_y(std::uint32_t a, std::uint32_t b) {
  return (std::bit_width(a ^ b) & 1) == 0;
}

}  // namespace delray::delaunay::internal
