// Shares of natural neighbours where doubles are not precise enough: sums of two doubles, scaled by
// a power of two, which do for grids that rounding has bent; then binary numbers of 256 bits, and
// of more, up to what makes every determinant of finite doubles exact.
#include "delaunay/natural_neighbours/natural_shares.h"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <compare>

#include "delaunay/predicates/double_double.h"

namespace delray::delaunay::internal {
namespace {

// A DoubleDouble with all that shares are computed with.
class Twice {
 public:
  Twice() = default;
  Twice(double x) : value_{x, 0} {}  // NOLINT(google-explicit-constructor): as of any number

  explicit operator double() const { return value_.high; }
  Twice operator-() const { return Twice(DoubleDouble{-value_.high, -value_.low}); }
  Twice& operator+=(const Twice& b) { return *this = *this + b; }
  friend Twice operator+(const Twice& a, const Twice& b) { return Twice(a.value_ + b.value_); }
  friend Twice operator-(const Twice& a, const Twice& b) { return Twice(a.value_ - b.value_); }
  friend Twice operator*(const Twice& a, const Twice& b) { return Twice(a.value_ * b.value_); }
  friend Twice operator/(const Twice& a, const Twice& b) {
    const Twice first = a.value_.high / b.value_.high;
    const Twice left = a - first * b;
    const Twice second = left.value_.high / b.value_.high;
    return first + second + Twice((left - second * b).value_.high / b.value_.high);
  }
  friend std::partial_ordering operator<=>(const Twice& a, const Twice& b) {
    const auto high = a.value_.high <=> b.value_.high;
    return high != 0 ? high : a.value_.low <=> b.value_.low;
  }
  friend Twice abs(const Twice& a) { return a.value_.high < 0 ? -a : a; }

 private:
  explicit Twice(const DoubleDouble& value) : value_(value) {}

  DoubleDouble value_{0, 0};
};

template <unsigned bits>
using Wide = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<bits, boost::multiprecision::digit_base_2>,
    boost::multiprecision::et_off>;

}  // namespace

// A product is off by 2^-103 of itself, a quotient by some of that.
template <>
struct Precision<Twice> {
  static constexpr double kRelative = 0x1p-100;
  static bool in_range(const Twice& length) {
    return Precision<double>::in_range(static_cast<double>(length));
  }
};

// Differences of positions in a plane of space are off by u of the positions themselves: 48 bits
// are left for how much smaller they may be.
template <unsigned bits>
struct Precision<Wide<bits>> {
  inline static const Wide<bits> kRelative = ldexp(Wide<bits>(1), 48 - static_cast<int>(bits));
  static bool in_range(const Wide<bits>& length) { return length > 0; }
};

namespace {

// Calls compute with numbers of more and more bits until it returns a value.
template <class Compute>
std::vector<NaturalNeighbour> with_bits(const Compute& compute) {
  SharesFound found = compute(Wide<256>());
  if (!found) found = compute(Wide<1536>());
  if (!found) found = compute(Wide<9216>());
  return found ? *std::move(found) : std::vector<NaturalNeighbour>{};
}

// Scales by a power of two, exactly or not at all, what is then not far from 1.
class Scale {
 public:
  void see(double x) { largest_ = std::max(largest_, std::abs(x)); }
  void choose() { exponent_ = largest_ > 0 ? -std::ilogb(largest_) : 0; }
  double of(double x) {
    const double scaled = std::ldexp(x, exponent_);
    is_exact_ &= std::ldexp(scaled, -exponent_) == x;
    return scaled;
  }
  bool is_exact() const { return is_exact_; }

 private:
  double largest_ = 0;
  int exponent_ = 0;
  bool is_exact_ = true;
};

template <class T>
std::vector<Triangle<T>> converted(const std::vector<Triangle<double>>& cavity) {
  std::vector<Triangle<T>> result;
  for (const Triangle<double>& t : cavity) {
    Triangle<T>& triangle = result.emplace_back();
    triangle.rows = t.rows;
    for (std::size_t k = 0; k < 3; ++k) triangle.at[k] = {T(t.at[k].x), T(t.at[k].y)};
  }
  return result;
}

}  // namespace

std::vector<NaturalNeighbour> wide_shares_of_area(const std::vector<Triangle<double>>& cavity,
                                                  const glm::dvec2& q) {
  Scale scale;
  for (const Triangle<double>& t : cavity) {
    for (const Vector2<double>& p : t.at) {
      scale.see(p.x);
      scale.see(p.y);
    }
  }
  scale.choose();
  std::vector<Triangle<double>> scaled = cavity;
  for (Triangle<double>& t : scaled) {
    for (Vector2<double>& p : t.at) p = {scale.of(p.x), scale.of(p.y)};
  }
  const Vector2<Twice> place = {scale.of(q.x), scale.of(q.y)};
  if (scale.is_exact()) {
    if (auto found = shares_of_area<Twice>(converted<Twice>(scaled), place)) return *found;
  }
  return with_bits([&](const auto& zero) {
    using T = std::decay_t<decltype(zero)>;
    return shares_of_area<T>(converted<T>(cavity), to_vector<T>(q));
  });
}

std::vector<NaturalNeighbour> wide_shares_of_volume(const std::vector<Tetrahedron>& cavity,
                                                    const glm::dvec3& q) {
  Scale scale;
  for (const Tetrahedron& t : cavity) {
    for (const glm::dvec3& p : t.at) {
      for (int k = 0; k < 3; ++k) scale.see(p[k]);
    }
  }
  scale.choose();
  const auto scaled_place = [&](const glm::dvec3& p) {
    return glm::dvec3(scale.of(p.x), scale.of(p.y), scale.of(p.z));
  };
  std::vector<Tetrahedron> scaled = cavity;
  for (Tetrahedron& t : scaled) {
    for (glm::dvec3& p : t.at) p = scaled_place(p);
  }
  const glm::dvec3 place = scaled_place(q);
  if (scale.is_exact()) {
    if (auto found = shares_of_volume<Twice>(scaled, place)) return *found;
  }
  return with_bits(
      [&](const auto& zero) { return shares_of_volume<std::decay_t<decltype(zero)>>(cavity, q); });
}

std::vector<NaturalNeighbour> wide_shares_in_plane(const std::vector<SpaceTriangle>& cavity,
                                                   const std::array<glm::dvec3, 3>& plane,
                                                   const glm::dvec3& q) {
  return with_bits([&](const auto& zero) {
    using T = std::decay_t<decltype(zero)>;
    const Vector3<T> origin = to_vector<T>(plane[0]);
    Vector3<T> u = to_vector<T>(plane[1]) - origin;
    Vector3<T> v = cross(cross(u, to_vector<T>(plane[2]) - origin), u);
    u = T(1 / sqrt(dot(u, u))) * u;
    v = T(1 / sqrt(dot(v, v))) * v;
    const Vector3<T> from = to_vector<T>(q);
    std::vector<Triangle<T>> flat;
    for (const SpaceTriangle& t : cavity) {
      Triangle<T>& triangle = flat.emplace_back();
      triangle.rows = t.rows;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vector3<T> p = to_vector<T>(t.at[k]) - from;
        triangle.at[k] = {dot(p, u), dot(p, v)};
      }
    }
    return shares_of_area<T>(flat, Vector2<T>{T(0), T(0)});
  });
}

}  // namespace delray::delaunay::internal
