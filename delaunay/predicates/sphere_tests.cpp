// Derives from the bounding box and the grid of a mesh's points which stages of the tests are
// exact, and holds their last, rare stages.
#include "delaunay/predicates/sphere_tests.h"

namespace delray::delaunay::internal {

SphereTests::SphereTests(const PointRange& range) {
  const glm::dvec3 size = range.high - range.low;
  orient_error_ = orient_error(size);
  insphere_error_ = insphere_error(size);
  bounds_ = {.insphere_error = insphere_error_,
             .has_second_stage = insphere_error_ < std::numeric_limits<double>::infinity(),
             .ties_are_exact = false};
  const glm::dvec3 farthest = max(abs(range.low), abs(range.high));
  const double largest = std::max({farthest.x, farthest.y, farthest.z});
  // Powers of the grid's step up to the fifth must neither underflow nor overflow.
  if (std::abs(range.grid_exponent) > 180) return;
  if (std::ldexp(largest, -range.grid_exponent) >= 0x1p61) return;
  scale_ = std::ldexp(1.0, -range.grid_exponent);
  const double steps = std::max({size.x, size.y, size.z}) * scale_;
  // Sums of 6 products of three, and of 72 of five, below 2^53.
  orient_is_exact_ = steps <= 0x1p16;
  insphere_is_exact_ = steps <= 0x1p9;
  if (orient_is_exact_) orient_error_ = 0;
  if (insphere_is_exact_) bounds_ = {.insphere_error = 0, .ties_are_exact = true};
  insphere_error_ = bounds_.insphere_error;
}

int SphereTests::beyond_filter(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                               const glm::dvec3& q) const {
  if (scale_ != 0) return wide_orient_sign(on_grid(a, q), on_grid(b, q), on_grid(c, q));
  return delaunay::orient3d(q, a, b, c);
}

int SphereTests::insphere_beyond_filter(const glm::dvec3& a, const glm::dvec3& b,
                                        const glm::dvec3& c, const glm::dvec3& d,
                                        const glm::dvec3& q) const {
  if (scale_ != 0) {
    return wide_insphere_sign(on_grid(a, q), on_grid(b, q), on_grid(c, q), on_grid(d, q));
  }
  return delaunay::insphere(a, b, c, d, q);
}

}  // namespace delray::delaunay::internal
