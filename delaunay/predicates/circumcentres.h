// Centres of circumscribed circles and spheres in numbers of any precision, with bounds of how far
// off they are.
//
// With a relative error u of each operation and of each difference of two coordinates, in norms
// that are sums of absolute values: a cross product of a and b is off by at most 5 u |a| |b|, a
// determinant of a, b and c by 16 u |a| |b| |c| (3 u of its factors, 5 for a minor, 5 for the sum
// of three, and second orders), the numerator of a centre by 24 u |a| |b| |c| (|a| + |b| + |c|),
// and likewise in 2D. Constants are rounded up.
#pragma once

#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <type_traits>

#include "delaunay/predicates/expansion.h"

namespace delray::delaunay::internal {

// u, and whether numbers overflow or underflow; for others than double see natural_shares.cpp.
template <class T>
struct Precision;
template <>
struct Precision<double> {
  static constexpr double kRelative = 0x1p-53;
  // Edges between these lengths leave all products of eight within the range of doubles.
  static bool in_range(double length) { return length > 0x1p-110 && length < 0x1p110; }
};

template <class T>
struct Vector2 {
  T x, y;
};
template <class T>
struct Vector3 {
  T x, y, z;
};

template <class T>
Vector2<T> operator-(const Vector2<T>& a, const Vector2<T>& b) {
  return {a.x - b.x, a.y - b.y};
}
template <class T>
Vector2<T> operator+(const Vector2<T>& a, const Vector2<T>& b) {
  return {a.x + b.x, a.y + b.y};
}
template <class T>
Vector3<T> operator-(const Vector3<T>& a, const Vector3<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
Vector3<T> operator+(const Vector3<T>& a, const Vector3<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
Vector3<T> operator*(const T& s, const Vector3<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class T>
T cross(const Vector2<T>& a, const Vector2<T>& b) {
  return a.x * b.y - a.y * b.x;
}
template <class T>
Vector3<T> cross(const Vector3<T>& a, const Vector3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
T dot(const Vector3<T>& a, const Vector3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
T norm(const Vector2<T>& a) {
  using std::abs;
  return abs(a.x) + abs(a.y);
}
template <class T>
T norm(const Vector3<T>& a) {
  using std::abs;
  return abs(a.x) + abs(a.y) + abs(a.z);
}

// In double, a difference of coordinates is off by u of itself.
template <class T>
Vector2<T> to_vector(const glm::dvec2& p) {
  return {T(p.x), T(p.y)};
}
template <class T>
Vector3<T> to_vector(const glm::dvec3& p) {
  return {T(p.x), T(p.y), T(p.z)};
}

// A centre in doubles that is off by less than this part of its distance is good enough: 2^14 less
// than what shares may be off by, as parts are many and cancel out.
constexpr double kGoodCentre = 0x1p-46;

// The middle of a circle or sphere, as seen from q; `error` is negative where it is not known.
template <class Vector, class T>
struct Centre {
  Vector at;
  T error;
  bool known() const { return error >= 0; }
};

// The circle through three points: `at` as they are, of which q is subtracted.
template <class T>
Centre<Vector2<T>, T> centre_of(const std::array<Vector2<T>, 3>& at, const Vector2<T>& q) {
  using std::abs;
  const Vector2<T> a = at[1] - at[0], b = at[2] - at[0], p = at[0] - q;
  const T kU = Precision<T>::kRelative, la = norm(a), lb = norm(b);
  const T determinant = cross(a, b), product = la * lb, off = T(12) * kU * product;
  if (!Precision<T>::in_range(la) || !Precision<T>::in_range(lb) ||
      !(abs(determinant) > T(2) * off)) {
    return {p, T(-1)};
  }
  const T aa = a.x * a.x + a.y * a.y, bb = b.x * b.x + b.y * b.y;
  const Vector2<T> sum = {b.y * aa - a.y * bb, a.x * bb - b.x * aa};
  const T scale = T(1) / (T(2) * determinant);
  const Vector2<T> h = {scale * sum.x, scale * sum.y};
  const T error = (T(20) * kU * product * (la + lb) + T(2) * norm(h) * off) /
                      (T(2) * (abs(determinant) - off)) +
                  T(6) * kU * (norm(h) + norm(p));
  return {p + h, error};
}

// A sphere through the origin and the ends of a, b and c, which are rounded differences.
template <class T>
struct Sphere {
  Sphere(const Vector3<T>& to_a, const Vector3<T>& to_b, const Vector3<T>& to_c)
      : a(to_a), b(to_b), c(to_c), la(norm(a)), lb(norm(b)), lc(norm(c)) {
    bc = cross(b, c);
    ca = cross(c, a);
    ab = cross(a, b);
    determinant = dot(a, bc);
    product = la * lb * lc;
    off = T(16) * Precision<T>::kRelative * product;
  }

  bool known() const {
    using std::abs;
    return Precision<T>::in_range(la) && Precision<T>::in_range(lb) && Precision<T>::in_range(lc) &&
           abs(determinant) > T(2) * off;
  }
  // The h with 2 a h = of_a and so on.
  Vector3<T> solution(const T& of_a, const T& of_b, const T& of_c) const {
    return (T(1) / (T(2) * determinant)) * (of_a * bc + of_b * ca + of_c * ab);
  }
  // The error of h, a solution whose numerator may be off by `numerator_off`.
  T error(const Vector3<T>& h, const T& numerator_off) const {
    using std::abs;
    return (numerator_off + T(2) * norm(h) * off) / (T(2) * (abs(determinant) - off));
  }

  Vector3<T> a, b, c, bc, ca, ab;
  T la, lb, lc, determinant, product, off;
};

// a (a - 2 h) of the difference a = end - start: none if h is the centre of a sphere through both,
// as seen from `start`.
//
// With a = high + low in every coordinate, and high - 2 h the exact sum of two doubles d and e, the
// products low e and low^2 are left out, u^2 |a| (2 |a| + 2 |h|) at most. Of the terms that are
// rounded high d, the largest, is exact as a product and in its sum; the others, and the errors of
// that sum, are together at most u |a| (6 |a| + 10 |h|) and take some ten roundings. So the result
// is off by at most u of itself and 128 u^2 |a| (|a| + |h|).
inline double residual(const Vector3<double>& start, const Vector3<double>& end,
                       const Vector3<double>& h) {
  double low = 0;
  const auto product = [&](double from, double to, double centre) {
    const TwoDoubles a = two_sum(to, -from), d = two_sum(a.high, -2 * centre);
    const TwoDoubles largest = two_product(a.high, d.high);
    low += largest.low + (a.high * d.low + a.low * (d.high + a.high));
    return largest.high;
  };
  const double x = product(start.x, end.x, h.x), y = product(start.y, end.y, h.y);
  const TwoDoubles two = two_sum(x, y), all = two_sum(two.high, product(start.z, end.z, h.z));
  return all.high + (low + (two.low + all.low));
}

// One step of Newton's method from h: what is left of its error, as a bound, and h, mended.
//
// The residuals of the three edges are off by u of themselves and 128 u^2 |a| (|a| + |h|), with
// which they are multiplied by minors of at most |b| |c|; minors, products and sums add 8 u.
inline double improve(const Sphere<double>& sphere, const std::array<Vector3<double>, 4>& at,
                      Vector3<double>& h) {
  constexpr double kU = Precision<double>::kRelative;
  const double a = residual(at[0], at[1], h), b = residual(at[0], at[2], h),
               c = residual(at[0], at[3], h);
  const double terms = std::abs(a) * sphere.lb * sphere.lc + std::abs(b) * sphere.lc * sphere.la +
                       std::abs(c) * sphere.la * sphere.lb;
  const double squares = sphere.product * (sphere.la + sphere.lb + sphere.lc + 3 * norm(h));
  const Vector3<double> step = sphere.solution(a, b, c);
  h = h + step;
  return sphere.error(step, 10 * kU * terms + 128 * kU * kU * squares) + 3 * kU * norm(step);
}

// The sphere through four points. Where simplices are long or flat the bound in doubles is far
// above the error, so that a step of Newton's method is worth it.
template <class T>
Centre<Vector3<T>, T> centre_of(const std::array<Vector3<T>, 4>& at, const Vector3<T>& q) {
  const Vector3<T> p = at[0] - q;
  const Sphere<T> sphere(at[1] - at[0], at[2] - at[0], at[3] - at[0]);
  if (!sphere.known()) return {p, T(-1)};
  const T kU = Precision<T>::kRelative;
  Vector3<T> h =
      sphere.solution(dot(sphere.a, sphere.a), dot(sphere.b, sphere.b), dot(sphere.c, sphere.c));
  T error = sphere.error(h, T(24) * kU * sphere.product * (sphere.la + sphere.lb + sphere.lc));
  if constexpr (std::is_same_v<T, double>) {
    if (error > kGoodCentre * norm(h)) error = improve(sphere, at, h);
  }
  return {p + h, error + T(6) * kU * (norm(h) + norm(p))};
}

}  // namespace delray::delaunay::internal
