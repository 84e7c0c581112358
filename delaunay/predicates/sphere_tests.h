// The 3D predicates for the points of one mesh, made faster by what is known of all its points.
//
// Stages: one error bound for the whole mesh from the extent of its bounding box; a bound from the
// extent of the points at hand; exact integers where all coordinates share a power-of-two grid
// (wide_determinants.h); the predicates for any points. If the grid is so coarse that doubles hold
// every product, the first stage is exact and decides zeros as well.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>

#include "delaunay/predicates.h"
#include "delaunay/predicates/wide_determinants.h"

namespace delray::delaunay::internal {

// Bounds that hold for all points of a mesh.
struct PointRange {
  glm::dvec3 low{0}, high{0};  // bounding box
  // Every coordinate is a multiple of 2^grid_exponent; 0 if all are 0.
  int grid_exponent = 0;
};

// The part of SphereTests that code for vector registers shares.
struct SphereBounds {
  // Errors of a rounded determinant of the sphere test: for all points of the mesh, and over the
  // product of the extents and the largest lift of the points at hand.
  double insphere_error = 0;
  static constexpr double kInsphereError = 18 * 24 * kRoundOff;
  // Whether the bound over the points at hand holds: nothing overflows on the way.
  bool has_second_stage = false;
  // Whether the signs of all determinants of differences of points are exact, and so is
  // (x * kTieShift + y) * kTieShift + z for a difference (x, y, z), which then is ordered as the
  // differences are lexicographically.
  bool ties_are_exact = false;
  static constexpr double kTieShift = 0x1p17;
};

class SphereTests {
 public:
  explicit SphereTests(const PointRange& range);

  const SphereBounds& bounds() const { return bounds_; }

  int orient3d(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
               const glm::dvec3& d) const {
    const glm::dvec3 p = a - d, q = b - d, r = c - d;
    // Relative to the last point the frame is reversed.
    return -orient_relative(p, q, r, [&] { return beyond_filter(a, b, c, d); });
  }

  // The sign of det(a - q, b - q, c - q), that is orient3d(q, a, b, c), from the differences.
  template <class Beyond>
  int orient_relative(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                      const Beyond& beyond) const {
    const double determinant = a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) +
                               a.z * (b.x * c.y - b.y * c.x);
    if (determinant > orient_error_) return 1;
    if (determinant < -orient_error_) return -1;
    return orient_is_exact_ ? 0 : beyond();
  }

  // det(a - q, b - q, c - q), decided by the later stages.
  int orient_exactly(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                     const glm::dvec3& q) const {
    return beyond_filter(a, b, c, q);
  }

  // insphere(), decided by the later stages.
  int insphere_exactly(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                       const glm::dvec3& d, const glm::dvec3& q) const {
    return insphere_beyond_filter(a, b, c, d, q);
  }

  int insphere(const glm::dvec3& p0, const glm::dvec3& p1, const glm::dvec3& p2,
               const glm::dvec3& p3, const glm::dvec3& q) const {
    const glm::dvec3 a = p0 - q, b = p1 - q, c = p2 - q, d = p3 - q;
    const double ab = a.x * b.y - a.y * b.x, ac = a.x * c.y - a.y * c.x;
    const double ad = a.x * d.y - a.y * d.x, bc = b.x * c.y - b.y * c.x;
    const double bd = b.x * d.y - b.y * d.x, cd = c.x * d.y - c.y * d.x;
    const double bcd = b.z * cd - c.z * bd + d.z * bc, acd = a.z * cd - c.z * ad + d.z * ac;
    const double abd = a.z * bd - b.z * ad + d.z * ab, abc = a.z * bc - b.z * ac + c.z * ab;
    const auto lift = [](const glm::dvec3& p) { return p.x * p.x + p.y * p.y + p.z * p.z; };
    const double determinant = (lift(a) * bcd - lift(b) * acd) + (lift(c) * abd - lift(d) * abc);
    if (determinant > insphere_error_) return 1;
    if (determinant < -insphere_error_) return -1;
    if (insphere_is_exact_) return 0;
    const glm::dvec3 size = max(max(abs(a), abs(b)), max(abs(c), abs(d)));
    const double error = insphere_error(size);
    if (determinant > error) return 1;
    if (determinant < -error) return -1;
    return insphere_beyond_filter(p0, p1, p2, p3, q);
  }

 private:
  // Bounds on the rounding of the determinants above if no coordinate of a difference exceeds that
  // of `size`. A term of the orientation passes 8 roundings and there are 6 of them; a term of the
  // sphere test passes 16, and there are 24 times a lift. The rest is for second-order terms, the
  // rounding of the bound, and products that underflow (predicates.h). Where a product on the way
  // may overflow although the term does not, nothing is decided.
  static constexpr double kLargest = 0x1p+190;
  static double orient_error(const glm::dvec3& size) {
    const double largest = std::max({1.0, size.x, size.y, size.z});
    if (!(largest < kLargest)) return std::numeric_limits<double>::infinity();
    return 9 * kRoundOff * 6 * (size.x * size.y * size.z) + kUnderflow * largest;
  }
  static double insphere_error(const glm::dvec3& size) {
    const double largest = std::max({1.0, size.x, size.y, size.z});
    if (!(largest < kLargest)) return std::numeric_limits<double>::infinity();
    const double lift = size.x * size.x + size.y * size.y + size.z * size.z;
    return SphereBounds::kInsphereError * (size.x * size.y * size.z) * lift +
           kUnderflow * largest * largest * largest;
  }

  Integers3 on_grid(const glm::dvec3& p, const glm::dvec3& q) const {
    Integers3 result;
    for (int k = 0; k < 3; ++k) {
      result[static_cast<std::size_t>(k)] =
          static_cast<std::int64_t>(p[k] * scale_) - static_cast<std::int64_t>(q[k] * scale_);
    }
    return result;
  }

  int beyond_filter(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                    const glm::dvec3& q) const;
  int insphere_beyond_filter(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                             const glm::dvec3& d, const glm::dvec3& q) const;

  double orient_error_, insphere_error_;
  SphereBounds bounds_;
  double scale_ = 0;  // from coordinates to integers below 2^61; 0 if there is no such grid
  bool orient_is_exact_ = false, insphere_is_exact_ = false;
};

}  // namespace delray::delaunay::internal
