// The geometric predicates beyond the filters that are inlined: the filters in space and the exact
// stages.
//
// All stages evaluate the same determinant template on different number types, cheapest first:
// 128-bit integers where all differences share a power-of-two grid, double-doubles with an error
// bound, expansions of doubles (Shewchuk 1997). Coordinates for which these could overflow or
// underflow go to integers of any size. Costs are in predicates.h.
//
// Degenerate: a determinant of zero is found by the integer stage on lattices, and by expansions or
// large integers elsewhere.
#include "delaunay/predicates.h"

#include <algorithm>
#include <array>
#include <bit>
#include <boost/multiprecision/cpp_int.hpp>
#include <cstdint>
#include <utility>

#include "delaunay/predicates/determinants.h"
#include "delaunay/predicates/double_double.h"
#include "delaunay/predicates/expansion.h"

namespace delray::delaunay {
namespace {

using internal::DoubleDouble;
using internal::Expansion;
using internal::Magnitude;
using internal::Relative;
using internal::TwoDoubles;
using BigInteger = boost::multiprecision::cpp_int;
__extension__ using Integer = __int128;

// A predicate of N + 1 points in D dimensions: its determinant is homogeneous of degree kDegree in
// the coordinates of the first N points relative to the last.
template <int D, int N>
struct Predicate {
  static constexpr int kDegree = N == D ? D : D + 2;

  template <class Number>
  static Number determinant(const std::array<Relative<Number, D>, N>& p) {
    if constexpr (D == 2 && N == 2) {
      return internal::determinant2(p[0], p[1]);
    } else if constexpr (D == 2) {
      return internal::incircle_determinant(p[0], p[1], p[2]);
    } else if constexpr (N == 3) {
      return internal::determinant3(p[0], p[1], p[2]);
    } else {
      return internal::insphere_determinant(p[0], p[1], p[2], p[3]);
    }
  }
};

template <class T>
int sign_of(const T& value) {
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

template <int D>
using Point = glm::vec<D, double, glm::defaultp>;

// Whether no step of the determinant overflows or underflows: then every number that occurs is a
// multiple of the degree-th power of the smallest unit in the last place, 2^-52 of the smallest
// coordinate, and stays below 2^12 times the degree-th power of twice the largest coordinate.
// 2^996 is where splitting a double would overflow.
template <int Degree, int D, std::size_t M>
bool in_window(const std::array<Point<D>, M>& points) {
  constexpr int kLow = -1074 / Degree + 52 + 1, kHigh = (996 - 12) / Degree - 2;
  static_assert(Degree * (kLow - 52) >= -1074);
  const double low = std::bit_cast<double>(std::uint64_t{1023 + kLow} << 52);
  const double high = std::bit_cast<double>(std::uint64_t{1023 + kHigh} << 52);
  for (const Point<D>& p : points) {
    for (int k = 0; k < D; ++k) {
      const double x = std::abs(p[k]);
      if (x > high || (x < low && x != 0)) return false;
    }
  }
  return true;
}

template <int D, std::size_t M>
std::array<Relative<TwoDoubles, D>, M - 1> differences(const std::array<Point<D>, M>& points) {
  std::array<Relative<TwoDoubles, D>, M - 1> result;
  for (std::size_t i = 0; i + 1 < M; ++i) {
    for (int k = 0; k < D; ++k) {
      result[i][k] = internal::two_sum(points[i][k], -points[M - 1][k]);
    }
  }
  return result;
}

template <class Number, int D, std::size_t N, class Convert>
std::array<Relative<Number, D>, N> convert_each(const std::array<Relative<TwoDoubles, D>, N>& from,
                                                const Convert& convert) {
  std::array<Relative<Number, D>, N> result;
  for (std::size_t i = 0; i < N; ++i) {
    for (int k = 0; k < D; ++k) result[i][k] = convert(from[i][k]);
  }
  return result;
}

// The differences as integers of at most kBits bits, times a common power of two, if they are such.
template <int D, std::size_t N>
bool on_grid(const std::array<Relative<TwoDoubles, D>, N>& relative,
             std::array<Relative<Integer, D>, N>& integers) {
  // Lifted sums have 2 bits more than a square, minors 3 more than a product, their sum 3 more.
  constexpr int kBits = N == D ? 120 / D : (126 - 8) / (D + 2);
  double largest = 0, inexact = 0;
  for (const auto& p : relative) {
    for (const TwoDoubles& x : p) {
      largest = std::max(largest, std::abs(x.high));
      inexact = std::max(inexact, std::abs(x.low));
    }
  }
  if (inexact != 0) return false;
  // 2^(kBits - 1) over the power of two below `largest`, without a division.
  constexpr int kShift = std::min(kBits, 52) - 1;
  const std::uint64_t exponent = std::bit_cast<std::uint64_t>(largest) >> 52;
  if (exponent == 0 || exponent > 2046) return largest == 0 && (integers = {}, true);
  const double scale = std::bit_cast<double>((2046 + kShift - exponent) << 52);
  for (std::size_t i = 0; i < N; ++i) {
    for (int k = 0; k < D; ++k) {
      const double scaled = relative[i][k].high * scale;
      const auto integer = static_cast<std::int64_t>(scaled);
      if (static_cast<double>(integer) != scaled) return false;
      integers[i][k] = integer;
    }
  }
  return true;
}

// Coordinates as integers times a common power of two, whatever their range is.
template <int D, int N, std::size_t M>
int sign_by_big_integers(const std::array<Point<D>, M>& points) {
  int lowest = 2000;
  for (const Point<D>& p : points) {
    for (int k = 0; k < D; ++k) {
      int exponent;
      if (std::frexp(p[k], &exponent) != 0) lowest = std::min(lowest, exponent - 53);
    }
  }
  const auto integer = [lowest](double x) {
    int exponent;
    const double mantissa = std::frexp(x, &exponent);
    BigInteger result(static_cast<std::int64_t>(std::ldexp(mantissa, 53)));
    if (mantissa != 0) result <<= exponent - 53 - lowest;
    return result;
  };
  std::array<Relative<BigInteger, D>, N> relative;
  for (std::size_t i = 0; i < N; ++i) {
    for (int k = 0; k < D; ++k) relative[i][k] = integer(points[i][k]) - integer(points[N][k]);
  }
  return Predicate<D, N>::determinant(relative).sign();
}

template <int D, int N>
Decision decide_beyond_filter(const std::array<Point<D>, N + 1>& points) {
  using P = Predicate<D, N>;
  // Rounding of the determinant in double-doubles, relative to its magnitude: products and sums
  // nest at most 8 deep, 8 u^2 each (double_double.h), so 64 u^2 = 2^-100; the rest covers the
  // rounding of the magnitude.
  constexpr double kDoubleDoubleError = 0x1p-98;

  if (!in_window<P::kDegree, D>(points)) {
    return {sign_by_big_integers<D, N>(points), Stage::kBigInteger};
  }
  const auto relative = differences<D>(points);
  std::array<Relative<Integer, D>, N> integers;
  if (on_grid<D>(relative, integers)) {
    return {sign_of(P::template determinant<Integer>(integers)), Stage::kInteger};
  }
  const auto rough = P::template determinant<DoubleDouble>(
      convert_each<DoubleDouble, D>(relative, [](const TwoDoubles& x) {
        return DoubleDouble{x.high, x.low};
      }));
  const auto magnitude = P::template determinant<Magnitude>(convert_each<Magnitude, D>(
      relative, [](const TwoDoubles& x) { return Magnitude{std::abs(x.high)}; }));
  if (std::abs(rough.high) > kDoubleDoubleError * magnitude.value) {
    return {sign_of(rough.high), Stage::kDoubleDouble};
  }
  const auto exact = P::template determinant<Expansion>(
      convert_each<Expansion, D>(relative, [](const TwoDoubles& x) { return Expansion(x); }));
  return {exact.sign(), Stage::kExpansion};
}

// The filter in 3D: the determinant in doubles against its magnitude.
//
// `roundings` is the number of roundings on the way to the result, relative to the magnitude (7 and
// 16 in Shewchuk 1997; the sums here nest one deeper). A product that underflows is multiplied by
// at most kDegree - 2 further coordinates.
template <int N>
int sign_by_filter3(const std::array<Point<3>, N + 1>& points, double roundings) {
  std::array<Relative<double, 3>, N> relative;
  std::array<Relative<Magnitude, 3>, N> absolute;
  double largest = 1;
  for (std::size_t i = 0; i < N; ++i) {
    for (int k = 0; k < 3; ++k) {
      relative[i][k] = points[i][k] - points[N][k];
      absolute[i][k] = {std::abs(relative[i][k])};
      largest = std::max(largest, absolute[i][k].value);
    }
  }
  const double determinant = Predicate<3, N>::determinant(relative);
  const double magnitude = Predicate<3, N>::determinant(absolute).value;
  const double underflow = internal::kUnderflow * largest * (N == 3 ? 1.0 : largest * largest);
  const double error = roundings * internal::kRoundOff * magnitude + underflow;
  return determinant > error ? 1 : -determinant > error ? -1 : 0;
}

constexpr double kOrient3dRoundings = 8;
constexpr double kInsphereRoundings = 18;

}  // namespace

namespace internal {

Decision orient2d_beyond_filter(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return decide_beyond_filter<2, 2>({a, b, c});
}

Decision incircle_beyond_filter(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c,
                                const glm::dvec2& d) {
  return decide_beyond_filter<2, 3>({a, b, c, d});
}

}  // namespace internal

Decision decide_orient2d(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  const int sign = internal::filter_orient2d(a, b, c);
  return sign != 0 ? Decision{sign, Stage::kFilter} : internal::orient2d_beyond_filter(a, b, c);
}

Decision decide_incircle(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c,
                         const glm::dvec2& d) {
  const int sign = internal::filter_incircle(a, b, c, d);
  return sign != 0 ? Decision{sign, Stage::kFilter} : internal::incircle_beyond_filter(a, b, c, d);
}

Decision decide_orient3d(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                         const glm::dvec3& d) {
  // Relative to the last point the determinant is that of the frame in the reverse order.
  const std::array<Point<3>, 4> points = {c, b, a, d};
  const int sign = sign_by_filter3<3>(points, kOrient3dRoundings);
  return sign != 0 ? Decision{sign, Stage::kFilter} : decide_beyond_filter<3, 3>(points);
}

Decision decide_insphere(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                         const glm::dvec3& d, const glm::dvec3& e) {
  const std::array<Point<3>, 5> points = {a, b, c, d, e};
  const int sign = sign_by_filter3<4>(points, kInsphereRoundings);
  return sign != 0 ? Decision{sign, Stage::kFilter} : decide_beyond_filter<3, 4>(points);
}

int orient3d(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
  return decide_orient3d(a, b, c, d).sign;
}

int insphere(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d,
             const glm::dvec3& e) {
  return decide_insphere(a, b, c, d, e).sign;
}

}  // namespace delray::delaunay
