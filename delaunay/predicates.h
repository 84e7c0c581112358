// The geometric predicates of the triangulations. Each returns the sign (-1, 0 or +1) of a
// determinant, and it is the right sign for every finite double, denormal and huge ones included.
//
// A filter in floating point is inlined and decides nearly every call. What it leaves goes through
// stages that stay fast on lattices and circles (see Stage). Cost: about 2 ns (2D) by the filter,
// tens of ns by the integer and double-double stages, microseconds beyond.
//
// REQUIRES, for all of them: finite coordinates; rounding to nearest; denormals not flushed to
// zero.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace delray::delaunay {

// The stages that may decide a predicate, in the order in which they are tried.
enum class Stage {
  kFilter,        // floating point with an error bound (Shewchuk 1997)
  kInteger,       // differences that share a power-of-two grid, in 128-bit integers
  kDoubleDouble,  // about 106 bits with an error bound
  kExpansion,     // sums of doubles, exact while nothing overflows or underflows (Shewchuk 1997)
  kBigInteger,    // integers of any size
};

// A sign, and the stage that found it.
struct Decision {
  int sign;
  Stage stage;
};

// The predicates above with the stage that decided them.
Decision decide_orient2d(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c);
Decision decide_incircle(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c,
                         const glm::dvec2& d);
Decision decide_orient3d(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                         const glm::dvec3& d);
Decision decide_insphere(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                         const glm::dvec3& d, const glm::dvec3& e);

namespace internal {

constexpr double kRoundOff = 0x1p-53;  // relative error of one operation

// Products of doubles may underflow, each with an absolute error of at most 2^-1075. The filters
// add this, times what such an error is multiplied by, to their bounds. It is far above what is
// needed so that it is itself no denormal.
constexpr double kUnderflow = 0x1p-950;

// Two differences of doubles (one rounding each), their product (one) and the difference of two
// products (one): 4 roundings, but the last is relative to the result and only matters near zero,
// so 3, and a little for second-order terms.
constexpr double kOrient2dError = (3 + 16 * kRoundOff) * kRoundOff;

// With z(p) = (a - p) * conj(b - p) seen as complex numbers, incircle is the sign of the imaginary
// part of z(c) * conj(z(d)): a cross ratio. Each part of z takes 4 roundings relative to the sum of
// its two absolute products, hence at most relative to spread(p) = |a - p| |b - p| in the 1-norm;
// a product of two parts takes 9, their difference 10; 11 leaves room for second-order terms.
constexpr double kIncircleError = 11 * kRoundOff;

// The sign if the error bound decides, otherwise 0.
inline int filter_orient2d(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  const double left = (a.x - c.x) * (b.y - c.y);
  const double right = (a.y - c.y) * (b.x - c.x);
  const double determinant = left - right;
  const double error = kOrient2dError * (std::abs(left) + std::abs(right)) + kUnderflow;
  return determinant > error ? 1 : -determinant > error ? -1 : 0;
}

inline int filter_incircle(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c,
                           const glm::dvec2& d) {
  const double acx = a.x - c.x, acy = a.y - c.y, bcx = b.x - c.x, bcy = b.y - c.y;
  const double adx = a.x - d.x, ady = a.y - d.y, bdx = b.x - d.x, bdy = b.y - d.y;
  const double dot_c = acx * bcx + acy * bcy, cross_c = acx * bcy - acy * bcx;
  const double dot_d = adx * bdx + ady * bdy, cross_d = adx * bdy - ady * bdx;
  const double spread_c = (std::abs(acx) + std::abs(acy)) * (std::abs(bcx) + std::abs(bcy));
  const double spread_d = (std::abs(adx) + std::abs(ady)) * (std::abs(bdx) + std::abs(bdy));
  const double determinant = dot_c * cross_d - dot_d * cross_c;
  const double error =
      kIncircleError * (spread_c * spread_d) + kUnderflow * (1 + spread_c + spread_d);
  return determinant > error ? 1 : -determinant > error ? -1 : 0;
}

Decision orient2d_beyond_filter(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c);
Decision incircle_beyond_filter(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c,
                                const glm::dvec2& d);

}  // namespace internal

// +1 if a, b, c turn left (counterclockwise), -1 if they turn right, 0 if they are collinear.
inline int orient2d(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  const int sign = internal::filter_orient2d(a, b, c);
  return sign != 0 ? sign : internal::orient2d_beyond_filter(a, b, c).sign;
}

// +1 if d lies inside the circle through a, b, c, -1 outside, 0 on it, when a, b, c turn left; the
// negative of that when they turn right. If a, b, c are collinear the circle is a half-plane, and
// exchanging two of them still changes the sign.
inline int incircle(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c,
                    const glm::dvec2& d) {
  const int sign = internal::filter_incircle(a, b, c, d);
  return sign != 0 ? sign : internal::incircle_beyond_filter(a, b, c, d).sign;
}

// +1 if (b - a, c - a, d - a) is a right-handed frame, -1 if left-handed, 0 if the points are
// coplanar.
int orient3d(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d);

// +1 if e lies inside the sphere through a, b, c, d, -1 outside, 0 on it, when orient3d(a, b, c, d)
// is +1; the negative of that when it is -1.
int insphere(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d,
             const glm::dvec3& e);

}  // namespace delray::delaunay
