// Angles are compared by their cotangents, which fall as angles grow: a scalar product over twice
// an area. In doubles as intervals, and where these overlap as fractions of integers.
#include "delaunay/construction/smallest_angles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "delaunay/predicates.h"
#include "delaunay/predicates/as_integers.h"

namespace delray::delaunay::internal {
namespace {

// The corners of the triangles on both sides of the diagonal from corner 0 to corner 2, and of that
// from corner 1 to corner 3.
using Diagonal = std::array<std::array<unsigned, 3>, 2>;
constexpr Diagonal kFrom0 = {{{0, 1, 2}, {0, 2, 3}}}, kFrom1 = {{{1, 2, 3}, {1, 3, 0}}};

// Calls use(i, j, k) for the angle at corner i between j and k of all six.
template <class Use>
void for_angles(const Diagonal& diagonal, Use&& use) {
  for (const auto& t : diagonal) {
    use(t[0], t[1], t[2]);
    use(t[1], t[2], t[0]);
    use(t[2], t[0], t[1]);
  }
}

struct CotangentRange {
  double low, high;
};

// The largest cotangent. Each of two differences, a product and a sum is off by one rounding, so a
// scalar product and an area by 4 of the sum of their absolute products; kRoom is twice that.
CotangentRange largest_cotangent(const std::array<glm::dvec2, 4>& p, const Diagonal& diagonal) {
  constexpr double kRoom = 8 * kRoundOff;
  CotangentRange largest{-std::numeric_limits<double>::infinity(),
                         -std::numeric_limits<double>::infinity()};
  for_angles(diagonal, [&](unsigned i, unsigned j, unsigned k) {
    const glm::dvec2 u = p[j] - p[i], v = p[k] - p[i];
    const double dot = u.x * v.x + u.y * v.y, area = u.x * v.y - u.y * v.x;
    const double off = kRoom * (std::abs(u.x * v.x) + std::abs(u.y * v.y)) + kUnderflow;
    const double area_off = kRoom * (std::abs(u.x * v.y) + std::abs(u.y * v.x)) + kUnderflow;
    const double low = dot - off, high = dot + off;
    const double least = area - area_off, most = area + area_off;
    if (!(least > 0)) {
      largest.high = std::numeric_limits<double>::infinity();
      return;
    }
    const double low_quotient = low / (low > 0 ? most : least);
    const double high_quotient = high / (high > 0 ? least : most);
    largest.low = std::max(largest.low, low_quotient - kRoom * std::abs(low_quotient));
    largest.high = std::max(largest.high, high_quotient + kRoom * std::abs(high_quotient));
  });
  return largest;
}

struct ExactCotangent {
  Integer numerator, denominator;  // above 0

  bool operator<(const ExactCotangent& other) const {
    return numerator * other.denominator < other.numerator * denominator;
  }
};

ExactCotangent exact_largest_cotangent(const std::array<Integer, 8>& p, const Diagonal& diagonal) {
  ExactCotangent largest{0, 0};
  for_angles(diagonal, [&](unsigned i, unsigned j, unsigned k) {
    const Integer ux = p[2 * j] - p[2 * i], uy = p[2 * j + 1] - p[2 * i + 1];
    const Integer vx = p[2 * k] - p[2 * i], vy = p[2 * k + 1] - p[2 * i + 1];
    ExactCotangent cotangent{ux * vx + uy * vy, ux * vy - uy * vx};
    if (largest.denominator == 0 || largest < cotangent) largest = std::move(cotangent);
  });
  return largest;
}

}  // namespace

bool has_larger_angles(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c,
                       const glm::dvec2& d) {
  const std::array<glm::dvec2, 4> p = {a, b, c, d};
  const CotangentRange from_0 = largest_cotangent(p, kFrom0), from_1 = largest_cotangent(p, kFrom1);
  if (from_0.high < from_1.low) return true;
  if (from_1.high < from_0.low) return false;
  const auto integers = as_integers(std::array<double, 8>{a.x, a.y, b.x, b.y, c.x, c.y, d.x, d.y});
  return exact_largest_cotangent(integers, kFrom0) < exact_largest_cotangent(integers, kFrom1);
}

}  // namespace delray::delaunay::internal
