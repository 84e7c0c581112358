// The tests that merging two triangulations needs, about points seen from one edge.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "delaunay/mesh/blocks.h"
#include "delaunay/order/cells.h"
#include "delaunay/predicates/conflict.h"

namespace delray::delaunay::internal {

// A point p as the edge from a to b sees it: (a - p) * conj(b - p), whose angle is the one under
// which p sees the edge (predicates.h, kIncircleError). Comparing two of these is the incircle
// test.
struct EdgeView {
  EdgeView() = default;
  EdgeView(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p) {
    const double ax = a.x - p.x, ay = a.y - p.y, bx = b.x - p.x, by = b.y - p.y;
    dot = ax * bx + ay * by;
    cross = ax * by - ay * bx;
    spread = (std::abs(ax) + std::abs(ay)) * (std::abs(bx) + std::abs(by));
  }
  double dot, cross, spread;
};

class MergeFilter {
 public:
  // Looks at all points once. Several threads are those of the arena that the caller is in.
  MergeFilter(std::span<const glm::dvec2> points, const Box2d& box, int threads) {
    const double largest = std::max(
        {std::abs(box.low.x), std::abs(box.low.y), std::abs(box.high.x), std::abs(box.high.y)});
    if (largest > kLargest) {
      underflow_ = HUGE_VAL;
      return;
    }
    const double unit = common_unit(points, threads);
    if (unit < kSmallest) return;
    exact_cross_ = 0x1p+52 * unit * unit;
    exact_circle_ = exact_cross_ * unit * unit;
  }

  // Whether c lies strictly to the right of the line from a to b.
  bool right_of(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) const {
    const EdgeView seen(a, b, c);
    const double error = kCrossError * seen.spread + underflow_;
    if (std::abs(seen.cross) > error) return seen.cross < 0;
    if (seen.spread < exact_cross_) return seen.cross < 0;
    return orient2d(a, b, c) < 0;
  }

  // Whether p lies strictly to the left of the line from a to b.
  bool above(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p,
             const EdgeView& seen) const {
    const double error = kCrossError * seen.spread + underflow_;
    if (std::abs(seen.cross) > error) return seen.cross > 0;
    if (seen.spread < exact_cross_) return seen.cross > 0;
    return orient2d(a, b, p) > 0;
  }

  // Whether q is in conflict with the triangle a, b, p. REQUIRES: p is above.
  bool inside(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p, const EdgeView& seen_p,
              const glm::dvec2& q, const EdgeView& seen_q) const {
    const double determinant = seen_p.dot * seen_q.cross - seen_p.cross * seen_q.dot;
    const double spreads = seen_p.spread * seen_q.spread;
    const double error = kIncircleError * spreads + underflow_;
    if (std::abs(determinant) > error) return determinant > 0;
    if (spreads < exact_circle_) {
      return determinant != 0 ? determinant > 0 : cocircular_inside(a, b, p, q);
    }
    return circle_conflict(a, b, p, q);
  }

  // The errors that rounding can add to the cross and to the determinant of points close to each
  // other; below 0 if nothing is rounded. A cross or a determinant of 0 is never sure by `circle`.
  struct Bounds {
    double cross, circle;
  };
  // REQUIRES: of any two of the points |dx| + |dy| <= extent but for rounding.
  Bounds bounds(double extent) const {
    const double spread = (1 + 16 * kRoundOff) * (extent * extent), spreads = spread * spread;
    return {spread < exact_cross_ ? -1 : kCrossError * spread + underflow_,
            spreads < exact_circle_ ? 0 : kIncircleError * spreads + underflow_};
  }

 private:
  // Up to here a product that underflows, off by 2^-1075, is multiplied by less than 2^410.
  static constexpr double kLargest = 0x1p+200;
  // Down to here a product of four coordinates does not underflow.
  static constexpr double kSmallest = 0x1p-200;
  // 4 roundings, as in kIncircleError, and room for second-order terms.
  static constexpr double kCrossError = 4.5 * kRoundOff;

  // The exponent, as it is stored, of the lowest bit of any coordinate; 2046 if all are 0.
  static int lowest_exponent(std::span<const glm::dvec2> points) {
    int lowest = 2046;
    for (const glm::dvec2& p : points) {
      for (const double x : {p.x, p.y}) {
        const auto bits = std::bit_cast<std::uint64_t>(x);
        const int exponent = static_cast<int>(bits >> 52 & 0x7ff);
        const std::uint64_t mantissa = (bits & 0xfffffffffffffU) | std::uint64_t{1} << 52;
        if (x != 0) lowest = std::min(lowest, exponent + std::countr_zero(mantissa) - 52);
      }
    }
    return lowest;
  }

  // The largest power of two that all coordinates are multiples of; 1 if all are 0.
  static double common_unit(std::span<const glm::dvec2> points, int threads) {
    const Blocks blocks(points.size(), threads);
    std::vector<int> exponents(blocks.count());
    blocks.for_each([&](std::size_t block, std::size_t first, std::size_t last) {
      exponents[block] = lowest_exponent(points.subspan(first, last - first));
    });
    const int lowest = *std::ranges::min_element(exponents);
    if (lowest <= 0) return 0;
    return lowest == 2046 ? 1.0 : std::bit_cast<double>(static_cast<std::uint64_t>(lowest) << 52);
  }

  double underflow_ = 0x1p-600;  // what underflow may add to an error
  // Where the spread, or the product of two, is below this, nothing above is rounded at all.
  double exact_cross_ = 0, exact_circle_ = 0;
};

}  // namespace delray::delaunay::internal
