// A determinant is expanded by its last row, minors of the first rows by sets of columns: 2^N of
// them, N products each. With doubles the sum of the absolute products bounds the error: a
// difference is off by one rounding, a sum of D squares of them by D + 3, and the expansion by N (N
// + 1). Entries are kept from where products overflow or underflow. Beyond the bound integers
// decide.
#include "delaunay/dimensions/determinants.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "delaunay/predicates/as_integers.h"

namespace delray::delaunay::internal {
namespace {

template <class Number, int N>
using Matrix = std::array<std::array<Number, N>, N>;

// minors[columns] from those of one row less.
template <class Number, int N>
Number expand(const Matrix<Number, N>& matrix) {
  std::array<Number, std::size_t{1} << N> minors;
  minors[0] = 1;
  for (unsigned columns = 1; columns < minors.size(); ++columns) {
    const auto row = static_cast<unsigned>(std::popcount(columns)) - 1;
    Number sum = 0;
    bool is_negative = (row % 2) != 0;
    for (unsigned rest = columns; rest != 0; rest &= rest - 1) {
      const auto j = static_cast<unsigned>(std::countr_zero(rest));
      const Number product = matrix[row][j] * minors[columns & ~(1U << j)];
      if (is_negative) {
        sum -= product;
      } else {
        sum += product;
      }
      is_negative = !is_negative;
    }
    minors[columns] = sum;
  }
  return minors.back();
}

// The determinant and the sum of the absolute values of its products.
template <int N>
std::array<double, 2> expand_with_bound(const Matrix<double, N>& matrix) {
  std::array<double, std::size_t{1} << N> minors, bounds;
  minors[0] = bounds[0] = 1;
  for (unsigned columns = 1; columns < minors.size(); ++columns) {
    const auto row = static_cast<unsigned>(std::popcount(columns)) - 1;
    double sum = 0, bound = 0, sign = (row % 2) != 0 ? -1 : 1;
    for (unsigned rest = columns; rest != 0; rest &= rest - 1) {
      const auto j = static_cast<unsigned>(std::countr_zero(rest));
      const unsigned others = columns & ~(1U << j);
      sum += sign * (matrix[row][j] * minors[others]);
      bound += std::abs(matrix[row][j]) * bounds[others];
      sign = -sign;
    }
    minors[columns] = sum;
    bounds[columns] = bound;
  }
  return {minors.back(), bounds.back()};
}

// Nothing if doubles do not tell.
template <int N>
int likely_sign(const Matrix<double, N>& matrix) {
  constexpr double kLeast = 1e-30, kMost = 1e30;
  constexpr double kError =
      2 * (N * (N + 1) + 2 * N + 5) * (std::numeric_limits<double>::epsilon() / 2);
  for (const auto& row : matrix) {
    for (const double x : row) {
      const double size = std::abs(x);
      if (!(size == 0 || (size > kLeast && size < kMost))) return 0;
    }
  }
  const auto [determinant, bound] = expand_with_bound<N>(matrix);
  if (determinant > kError * bound) return 1;
  if (determinant < -kError * bound) return -1;
  return 0;
}

// The coordinates of points as integers, one after the other.
template <int D, std::size_t N>
auto integers_of(const std::array<const PlaceNd<D>*, N>& points) {
  std::array<double, N * D> coordinates;
  for (std::size_t i = 0; i < N; ++i) {
    std::ranges::copy(*points[i], coordinates.begin() + static_cast<std::ptrdiff_t>(i * D));
  }
  return as_integers(coordinates);
}

template <int D, class Number, class At>
Matrix<Number, D> differences(const At& at) {
  Matrix<Number, D> rows;
  for (int i = 0; i < D; ++i) {
    for (int j = 0; j < D; ++j) rows[i][j] = at(i + 1, j) - at(0, j);
  }
  return rows;
}

// Point D + 1 is the origin.
template <int D, class Number, class At>
Matrix<Number, D + 1> lifted(const At& at) {
  Matrix<Number, D + 1> rows;
  for (int i = 0; i <= D; ++i) {
    Number square = 0;
    for (int j = 0; j < D; ++j) {
      rows[i][j] = at(i, j) - at(D + 1, j);
      square += rows[i][j] * rows[i][j];
    }
    rows[i][D] = square;
  }
  return rows;
}

}  // namespace

template <int D>
int orientation_nd(const std::array<const PlaceNd<D>*, D + 1>& points) {
  const auto at = [&](int i, int j) { return (*points[i])[j]; };
  if (const int sign = likely_sign<D>(differences<D, double>(at)); sign != 0) return sign;
  const auto n = integers_of<D>(points);
  const auto exact = [&](int i, int j) -> const Integer& { return n[i * D + j]; };
  return expand<Integer, D>(differences<D, Integer>(exact)).sign();
}

template <int D>
int in_sphere_nd(const std::array<const PlaceNd<D>*, D + 1>& points, const PlaceNd<D>& q) {
  constexpr int kInside = D % 2 == 0 ? 1 : -1;
  std::array<const PlaceNd<D>*, D + 2> all;
  std::ranges::copy(points, all.begin());
  all[D + 1] = &q;
  const auto at = [&](int i, int j) { return (*all[i])[j]; };
  if (const int sign = likely_sign<D + 1>(lifted<D, double>(at)); sign != 0) return kInside * sign;
  const auto n = integers_of<D>(all);
  const auto exact = [&](int i, int j) -> const Integer& { return n[i * D + j]; };
  return kInside * expand<Integer, D + 1>(lifted<D, Integer>(exact)).sign();
}

template <int D>
bool conflict_nd(const std::array<const PlaceNd<D>*, D + 1>& points, const PlaceNd<D>& q) {
  if (const int sign = in_sphere_nd<D>(points, q); sign != 0) return sign > 0;
  std::array<unsigned, D + 1> order;
  for (unsigned k = 0; k <= D; ++k) order[k] = k;
  std::ranges::sort(order, [&](unsigned a, unsigned b) { return *points[b] < *points[a]; });
  for (const unsigned k : order) {
    if (*points[k] < q) return false;
    auto replaced = points;
    replaced[k] = &q;
    if (const int sign = orientation_nd<D>(replaced); sign != 0) return sign > 0;
  }
  return false;
}

#define DELRAY_DIMENSION(D)                                                                     \
  template int orientation_nd<D>(const std::array<const PlaceNd<D>*, D + 1>&);                  \
  template int in_sphere_nd<D>(const std::array<const PlaceNd<D>*, D + 1>&, const PlaceNd<D>&); \
  template bool conflict_nd<D>(const std::array<const PlaceNd<D>*, D + 1>&, const PlaceNd<D>&);
DELRAY_DIMENSION(2)
DELRAY_DIMENSION(3)
DELRAY_DIMENSION(4)
DELRAY_DIMENSION(5)
DELRAY_DIMENSION(6)
#undef DELRAY_DIMENSION

}  // namespace delray::delaunay::internal
