// Centres of circumscribed balls by Cramer's rule, relative to the first corner, with a bound of
// the error of each coordinate, so that a test that says no is right. The bounds add up relative
// errors of the terms (Higham 2002, chapter 3): a term of the determinant takes at most 6 roundings
// and one of the numerators at most 11, sums included; kFactor leaves room for both and for second
// order.
#include "delaunay/tiles/circumball.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "delaunay/predicates.h"

namespace delray::delaunay {
namespace {

constexpr double kRoundOff = 0x1p-53, kFactor = 16 * kRoundOff;
// Far above what products lose that underflow.
constexpr double kUnderflow = 0x1p-950;

// A number and the sum of the absolute values of its terms.
struct Term {
  double value = 0, size = 0;
};
Term operator+(const Term& a, const Term& b) { return {a.value + b.value, a.size + b.size}; }
Term operator-(const Term& a, const Term& b) { return {a.value - b.value, a.size + b.size}; }
Term operator*(const Term& a, const Term& b) { return {a.value * b.value, a.size * b.size}; }
Term term(double x) { return {x, std::abs(x)}; }

template <int D>
Term squared_length(const glm::vec<D, double, glm::defaultp>& v) {
  const double sum = glm::dot(v, v);
  return {sum, sum};
}

struct Cramer {
  std::array<Term, 3> numerators;
  Term determinant;
};

Cramer solve(const std::array<glm::dvec2, 2>& sides) {
  const glm::dvec2 &a = sides[0], &b = sides[1];
  const Term aa = squared_length<2>(a), bb = squared_length<2>(b);
  return {{term(b.y) * aa - term(a.y) * bb, term(a.x) * bb - term(b.x) * aa},
          term(a.x) * term(b.y) - term(a.y) * term(b.x)};
}

Cramer solve(const std::array<glm::dvec3, 3>& sides) {
  Cramer result;
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 &u = sides[(i + 1) % 3], &v = sides[(i + 2) % 3];
    const Term length = squared_length<3>(sides[i]);
    for (int k = 0; k < 3; ++k) {
      const int l = (k + 1) % 3, m = (k + 2) % 3;
      const Term cross = term(u[l]) * term(v[m]) - term(u[m]) * term(v[l]);
      result.numerators[k] = result.numerators[k] + length * cross;
      if (i == 0) result.determinant = result.determinant + term(sides[0][k]) * cross;
    }
  }
  return result;
}

template <class Facet, class Point, class Beyond>
bool any_corner(const Facet& facet, const geometry::Box<Point>& box, const Beyond& beyond) {
  for (unsigned corner = 0; corner < 1U << Point::length(); ++corner) {
    Point p;
    for (int k = 0; k < Point::length(); ++k) {
      p[k] = (corner >> k & 1) != 0 ? box.high[k] : box.low[k];
    }
    if (beyond(facet, p)) return true;
  }
  return false;
}

}  // namespace

template <int D>
Circumball<D>::Circumball(const std::array<Point, D + 1>& corners) : corner_(corners[0]) {
  std::array<Point, D> sides;
  for (int i = 0; i < D; ++i) sides[i] = corners[i + 1] - corner_;
  const Cramer system = solve(sides);
  const double error = kFactor * system.determinant.size + kUnderflow;
  const double least = std::abs(system.determinant.value) - error;
  if (!(least > 0)) {
    uncertain_ = std::numeric_limits<double>::infinity();
    return;
  }
  for (int k = 0; k < D; ++k) {
    const Term& numerator = system.numerators[k];
    centre_[k] = numerator.value / (2 * system.determinant.value);
    uncertain_ +=
        (kFactor * numerator.size + kUnderflow + 2 * std::abs(centre_[k]) * error) / (2 * least) +
        kFactor * std::abs(centre_[k]);
  }
  radius_ = glm::length(centre_);
}

template <int D>
bool Circumball<D>::touches(const geometry::Box<Point>& box) const {
  double squares = 0, reach = 0;
  for (int k = 0; k < D; ++k) {
    const double low = box.low[k] - corner_[k], high = box.high[k] - corner_[k];
    const double away = std::max({low - centre_[k], centre_[k] - high, 0.0});
    squares += away * away;
    reach = std::max({reach, std::abs(low), std::abs(high)});
  }
  // The other way round for numbers that are none.
  return !(std::sqrt(squares) > radius_ + slack(reach));
}

template <int D>
bool Circumball<D>::is_within(const geometry::Box<Point>& box) const {
  double margin = std::numeric_limits<double>::infinity(), reach = 0;
  for (int k = 0; k < D; ++k) {
    const double low = box.low[k] - corner_[k], high = box.high[k] - corner_[k];
    margin = std::min({margin, centre_[k] - low, high - centre_[k]});
    reach = std::max({reach, std::abs(low), std::abs(high)});
  }
  return margin > radius_ + slack(reach);
}

// By how much rounding may have moved the ball's surface or a box no farther than `reach` away.
template <int D>
double Circumball<D>::slack(double reach) const {
  return 2 * uncertain_ + kFactor * (radius_ + reach) + kUnderflow;
}

bool reaches_beyond(const std::array<glm::dvec2, 2>& facet, const geometry::Box<glm::dvec2>& box) {
  return any_corner(
      facet, box, [](const auto& f, const glm::dvec2& p) { return orient2d(f[0], f[1], p) <= 0; });
}

bool reaches_beyond(const std::array<glm::dvec3, 3>& facet, const geometry::Box<glm::dvec3>& box) {
  return any_corner(facet, box, [](const auto& f, const glm::dvec3& p) {
    return orient3d(f[0], f[1], f[2], p) >= 0;
  });
}

template class Circumball<2>;
template class Circumball<3>;

}  // namespace delray::delaunay
