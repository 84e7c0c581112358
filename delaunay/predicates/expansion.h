// Exact sums of doubles: a number is the sum of components that do not overlap, smallest first
// (J. R. Shewchuk, Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
// Predicates, 1997). Nothing here may overflow or underflow; the caller checks the window.
#pragma once

#include <cmath>
#include <vector>

namespace delray::delaunay::internal {

// high + low, exactly; high is the rounded sum or product.
struct TwoDoubles {
  double high, low;
};

inline TwoDoubles two_sum(double a, double b) {
  const double sum = a + b;
  const double b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}

// REQUIRES: |a| >= |b|, or a is 0.
inline TwoDoubles fast_two_sum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

// Dekker's product: fused multiply-add is not everywhere, and where it is the compiler must not
// choose it on its own.
inline TwoDoubles two_product(double a, double b) {
  constexpr double kSplitter = 0x1p27 + 1;
  const double product = a * b;
  const double a_big = kSplitter * a, b_big = kSplitter * b;
  const double a_high = a_big - (a_big - a), a_low = a - a_high;
  const double b_high = b_big - (b_big - b), b_low = b - b_high;
  const double error = ((product - a_high * b_high) - a_low * b_high) - a_high * b_low;
  return {product, a_low * b_low - error};
}

class Expansion {
 public:
  Expansion() = default;
  explicit Expansion(const TwoDoubles& x) {
    append(x.low);
    append(x.high);
  }

  int sign() const {
    if (parts_.empty()) return 0;
    return parts_.back() > 0 ? 1 : -1;
  }

  // Shewchuk's fast expansion sum without zero components.
  friend Expansion operator+(const Expansion& a, const Expansion& b) {
    if (a.parts_.empty()) return b;
    if (b.parts_.empty()) return a;
    Expansion sum;
    sum.parts_.reserve(a.parts_.size() + b.parts_.size());
    std::size_t i = 0, j = 0;
    const auto smallest_left = [&] {
      if (j == b.parts_.size()) return a.parts_[i++];
      if (i == a.parts_.size()) return b.parts_[j++];
      return std::abs(a.parts_[i]) < std::abs(b.parts_[j]) ? a.parts_[i++] : b.parts_[j++];
    };
    double carry = smallest_left();
    for (std::size_t left = a.parts_.size() + b.parts_.size() - 1; left > 0; --left) {
      const TwoDoubles step = two_sum(carry, smallest_left());
      sum.append(step.low);
      carry = step.high;
    }
    sum.append(carry);
    return sum;
  }

  friend Expansion operator-(const Expansion& a, const Expansion& b) { return a + b * -1.0; }

  friend Expansion operator*(const Expansion& a, double scale) {
    Expansion product;
    if (a.parts_.empty() || scale == 0) return product;
    product.parts_.reserve(2 * a.parts_.size());
    TwoDoubles carry = two_product(a.parts_[0], scale);
    product.append(carry.low);
    for (std::size_t i = 1; i < a.parts_.size(); ++i) {
      const TwoDoubles term = two_product(a.parts_[i], scale);
      const TwoDoubles low = two_sum(carry.high, term.low);
      product.append(low.low);
      carry = fast_two_sum(term.high, low.high);
      product.append(carry.low);
    }
    product.append(carry.high);
    return product;
  }

  friend Expansion operator*(const Expansion& a, const Expansion& b) {
    Expansion product;
    for (const double part : b.parts_) product = product + a * part;
    return product;
  }

 private:
  void append(double part) {
    if (part != 0) parts_.push_back(part);
  }

  std::vector<double> parts_;
};

}  // namespace delray::delaunay::internal
