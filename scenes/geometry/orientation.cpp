// The sign of a determinant of numbers of single precision (Shewchuk 1997).
//
// Products of two such numbers are exact in double precision. Where the plain determinant is
// smaller than its error may be, the six products of the expanded one are summed without any error.
#include "scenes/geometry/orientation.h"

#include <array>
#include <cmath>

namespace delray::scenes::internal {
namespace {

// Shewchuk's bound: differences, products and their difference are rounded once each, so that the
// error is at most (3 + 16 e) e times the sum of the products' magnitudes, e = 2^-53.
constexpr double kUnit = 0x1p-53;
constexpr double kBound = (3 + 16 * kUnit) * kUnit;

int sign(double x) { return (x > 0 ? 1 : 0) - (x < 0 ? 1 : 0); }

// Adds `value` to a sum held as parts that do not overlap, the largest last (Shewchuk's Grow).
template <std::size_t N>
void add(std::array<double, N>& parts, std::size_t count, double value) {
  for (std::size_t i = 0; i < count; ++i) {
    const double sum = value + parts[i];
    const double of_part = sum - value;
    parts[i] = (value - (sum - of_part)) + (parts[i] - of_part);
    value = sum;
  }
  parts[count] = value;
}

}  // namespace

int orientation(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  const double left = (a.x - c.x) * (b.y - c.y), right = (a.y - c.y) * (b.x - c.x);
  const double determinant = left - right;
  if (std::abs(determinant) > kBound * (std::abs(left) + std::abs(right))) return sign(determinant);
  const std::array products = {a.x * b.y, -a.y * b.x, b.x * c.y, -b.y * c.x, c.x * a.y, -c.y * a.x};
  std::array<double, products.size()> parts{};
  for (std::size_t i = 0; i < products.size(); ++i) add(parts, i, products[i]);
  for (std::size_t i = parts.size(); i-- > 0;) {
    if (parts[i] != 0) return sign(parts[i]);
  }
  return 0;
}

}  // namespace delray::scenes::internal
