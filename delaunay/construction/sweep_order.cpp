// Interval arithmetic decides nearly always: in double, then in long double, whose exponents hold
// products of any doubles where they have 15 bits. Otherwise coordinates become integers, and signs
// of a + b sqrt(c) + d sqrt(e) are found by squaring.
//
// With a as the origin, D = orient(a, b, c) and N the numerators of the centre, N / 2D, the top of
// the circle is a.y + (N.y + |N|) / 2D.
#include "delaunay/construction/sweep_order.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "delaunay/predicates/as_integers.h"

namespace delray::delaunay::internal {
namespace {

// What is lost below the least number. As large as this, so that products of what is nearly nothing
// are no denormal numbers, which take a hundred times as long.
template <class Float>
const Float kLeast = std::ldexp(Float{1}, std::numeric_limits<Float>::min_exponent / 2);

// Each operation rounds to nearest: an ulp more on either side holds the exact result.
template <class Float>
Interval<Float> widened(Float low, Float high) {
  constexpr Float kUlp = std::numeric_limits<Float>::epsilon();
  if (!(std::isfinite(low) && std::isfinite(high))) {
    return {-std::numeric_limits<Float>::infinity(), std::numeric_limits<Float>::infinity()};
  }
  return {low - std::abs(low) * kUlp - kLeast<Float>, high + std::abs(high) * kUlp + kLeast<Float>};
}
template <class Float>
Interval<Float> operator+(const Interval<Float>& a, const Interval<Float>& b) {
  return widened(a.low + b.low, a.high + b.high);
}
template <class Float>
Interval<Float> operator-(const Interval<Float>& a, const Interval<Float>& b) {
  return widened(a.low - b.high, a.high - b.low);
}
template <class Float>
Interval<Float> operator*(const Interval<Float>& a, const Interval<Float>& b) {
  const std::array<Float, 4> products = {a.low * b.low, a.low * b.high, a.high * b.low,
                                         a.high * b.high};
  for (const Float product : products) {
    if (std::isnan(product)) return widened(product, product);
  }
  return widened(*std::ranges::min_element(products), *std::ranges::max_element(products));
}
template <class Float>
Interval<Float> root(const Interval<Float>& a) {
  return widened(std::sqrt(std::max(a.low, Float{0})), std::sqrt(std::max(a.high, Float{0})));
}
template <class Float>
Interval<Float> difference(double a, double b) {
  return widened(Float{a} - Float{b}, Float{a} - Float{b});
}
// +1 or -1, or 0 if the interval does not tell.
template <class Float>
int sign_of(const Interval<Float>& a) {
  return a.low > 0 ? 1 : a.high < 0 ? -1 : 0;
}
int sign_of(const Integer& a) { return a.sign(); }

// +1 if a is larger, -1 if b is, 0 if the intervals do not tell.
template <class Float>
int order(const Interval<Float>& a, const Interval<Float>& b) {
  return a.low > b.high ? 1 : a.high < b.low ? -1 : 0;
}

// What `meet_left_of` is the sign of: s sees both parabolas straight below, at |p - s|^2 / 2 e.
template <class Number>
int which_is_higher(const Number& left_x, const Number& left_e, const Number& right_x,
                    const Number& right_e) {
  const Number left = left_x * left_x + left_e * left_e;
  const Number right = right_x * right_x + right_e * right_e;
  return sign_of(Number(right * left_e - left * right_e));
}

template <class Float>
int which_is_higher(const glm::dvec2& left, const glm::dvec2& right, const glm::dvec2& s) {
  return which_is_higher(difference<Float>(left.x, s.x), difference<Float>(s.y, left.y),
                         difference<Float>(right.x, s.x), difference<Float>(s.y, right.y));
}

// D, N.x and N.y of b and c seen from a.
template <class Number>
std::array<Number, 3> circle_of(const Number& bx, const Number& by, const Number& cx,
                                const Number& cy) {
  const Number b = bx * bx + by * by, c = cx * cx + cy * cy;
  return {Number(bx * cy - by * cx), Number(cy * b - by * c), Number(bx * c - cx * b)};
}

// The sign of p + u sqrt(l) - v sqrt(m). REQUIRES: u, v >= 0; l, m >= 0.
int sign_with_roots(const Integer& p, const Integer& u, const Integer& l, const Integer& v,
                    const Integer& m) {
  const Integer first = u * u * l, second = v * v * m;
  const Integer difference = first - second;
  const int roots = difference.sign(), own = p.sign();
  if (roots * own >= 0) return roots != 0 ? roots : own;
  // They have opposite signs: p^2 against (u sqrt(l) - v sqrt(m))^2.
  const Integer rest = p * p - first - second;
  const Integer product = 4 * first * second;
  int larger = 1;  // whose absolute value is larger: p's (+1) or that of the roots
  if (rest.sign() < 0) {
    const Integer surplus = product - rest * rest;
    larger = surplus.sign();
  } else if (rest.sign() == 0 && product.sign() == 0) {
    larger = 0;
  }
  return larger * own;
}

}  // namespace

bool meet_left_of(const glm::dvec2& left, const glm::dvec2& right, const glm::dvec2& s) {
  if (left.y == s.y && right.y == s.y) return true;
  // The higher point's parabola is above the other's only about that point.
  if (left.y > right.y && s.x <= left.x) return false;
  if (left.y < right.y && s.x >= right.x) return true;
  if (const int sign = which_is_higher<double>(left, right, s); sign != 0) return sign < 0;
  if (const int sign = which_is_higher<long double>(left, right, s); sign != 0) return sign < 0;
  const auto n = as_integers<6>({left.x, left.y, right.x, right.y, s.x, s.y});
  return which_is_higher(Integer(n[0] - n[4]), Integer(n[5] - n[1]), Integer(n[2] - n[4]),
                         Integer(n[5] - n[3])) < 0;
}

template <class Float>
Interval<Float> TopOfCircle::bounds() const {
  const auto& [a, b, c] = points_;
  const auto [d, x, y] = circle_of(difference<Float>(b.x, a.x), difference<Float>(b.y, a.y),
                                   difference<Float>(c.x, a.x), difference<Float>(c.y, a.y));
  const Float infinity = std::numeric_limits<Float>::infinity();
  if (sign_of(d) <= 0) return {-infinity, infinity};
  const Interval<Float> height = y + root(x * x + y * y);
  const Interval<Float> inverse = widened(Float{0.5} / d.high, Float{0.5} / d.low);
  return Interval<Float>{a.y, a.y} + height * inverse;
}

TopOfCircle::TopOfCircle(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c)
    : points_{a, b, c}, y_(bounds<double>()) {}

int TopOfCircle::compare(const TopOfCircle& other) const {
  if (const int sign = order(y_, other.y_); sign != 0) return sign;
  if (const int sign = order(bounds<long double>(), other.bounds<long double>()); sign != 0) {
    return sign;
  }
  std::array<double, 12> coordinates;
  for (unsigned i = 0; i < 3; ++i) {
    coordinates[2 * i] = points_[i].x;
    coordinates[2 * i + 1] = points_[i].y;
    coordinates[6 + 2 * i] = other.points_[i].x;
    coordinates[7 + 2 * i] = other.points_[i].y;
  }
  const auto n = as_integers(coordinates);
  const auto circle = [&](unsigned at) {
    return circle_of(Integer(n[at + 2] - n[at]), Integer(n[at + 3] - n[at + 1]),
                     Integer(n[at + 4] - n[at]), Integer(n[at + 5] - n[at + 1]));
  };
  const auto [d, x, y] = circle(0);
  const auto [other_d, other_x, other_y] = circle(6);
  const Integer p = other_d * y - d * other_y + 2 * d * other_d * (n[1] - n[7]);
  return sign_with_roots(p, other_d, x * x + y * y, d, other_x * other_x + other_y * other_y);
}

int TopOfCircle::compare(double y) const {
  if (const int sign = order(y_, {y, y}); sign != 0) return sign;
  if (const int sign = order<long double>(bounds<long double>(), {y, y}); sign != 0) return sign;
  const auto n = as_integers<7>(
      {points_[0].x, points_[0].y, points_[1].x, points_[1].y, points_[2].x, points_[2].y, y});
  const auto [d, x, up] = circle_of(Integer(n[2] - n[0]), Integer(n[3] - n[1]),
                                    Integer(n[4] - n[0]), Integer(n[5] - n[1]));
  const Integer p = up - 2 * d * (n[6] - n[1]);
  return sign_with_roots(p, 1, x * x + up * up, 0, 0);
}

}  // namespace delray::delaunay::internal
