// The determinants whose signs the predicates are, written once for every kind of number: doubles,
// double-doubles, 128-bit integers, expansions, integers of any size, and magnitudes.
//
// Points are given relative to the last point of the predicate.
#pragma once

#include <array>
#include <cmath>

namespace delray::delaunay::internal {

template <class Number, int D>
using Relative = std::array<Number, static_cast<std::size_t>(D)>;

// The sum of the absolute values of all terms of a determinant: what its rounding error is measured
// by. REQUIRES: values >= 0.
struct Magnitude {
  double value;
  friend Magnitude operator+(Magnitude a, Magnitude b) { return {a.value + b.value}; }
  friend Magnitude operator-(Magnitude a, Magnitude b) { return {a.value + b.value}; }
  friend Magnitude operator*(Magnitude a, Magnitude b) { return {a.value * b.value}; }
};

template <class Number>
Number determinant2(const Relative<Number, 2>& a, const Relative<Number, 2>& b) {
  return a[0] * b[1] - a[1] * b[0];
}

template <class Number>
Number determinant3(const Relative<Number, 3>& a, const Relative<Number, 3>& b,
                    const Relative<Number, 3>& c) {
  return a[2] * (b[0] * c[1] - b[1] * c[0]) + b[2] * (c[0] * a[1] - c[1] * a[0]) +
         c[2] * (a[0] * b[1] - a[1] * b[0]);
}

// > 0 if the origin is inside the circle through a, b, c, which turn left.
template <class Number>
Number incircle_determinant(const Relative<Number, 2>& a, const Relative<Number, 2>& b,
                            const Relative<Number, 2>& c) {
  const auto lift = [](const Relative<Number, 2>& p) { return p[0] * p[0] + p[1] * p[1]; };
  return lift(a) * determinant2(b, c) + lift(b) * determinant2(c, a) + lift(c) * determinant2(a, b);
}

// > 0 if the origin is inside the sphere through a, b, c, d with (b - a, c - a, d - a)
// right-handed.
template <class Number>
Number insphere_determinant(const Relative<Number, 3>& a, const Relative<Number, 3>& b,
                            const Relative<Number, 3>& c, const Relative<Number, 3>& d) {
  const auto lift = [](const Relative<Number, 3>& p) {
    return p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
  };
  return (lift(a) * determinant3(b, c, d) + lift(c) * determinant3(a, b, d)) -
         (lift(b) * determinant3(a, c, d) + lift(d) * determinant3(a, b, c));
}

}  // namespace delray::delaunay::internal
