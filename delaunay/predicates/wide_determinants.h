// The signs of the 3D predicates' determinants for integer coordinates, exactly, in words of 64
// bits.
//
// Doubles that share a power-of-two grid are integers up to a scale: lattices, LAS and float32
// data, but also full doubles of similar size. Products of words are so fast that this is no slower
// than an error bound in double-doubles would be, and it always decides.
#pragma once

#include <array>
#include <cstdint>

namespace delray::delaunay::internal {

__extension__ using Int128 = __int128;
__extension__ using UInt128 = unsigned __int128;

// Integer coordinates relative to another point. REQUIRES, for all below: |x| < 2^62.
using Integers3 = std::array<std::int64_t, 3>;

// high * 2^64 + low.
struct Int192 {
  std::uint64_t low;
  Int128 high;

  friend Int192 operator+(const Int192& a, const Int192& b) {
    const std::uint64_t sum = a.low + b.low;
    return {sum, a.high + b.high + (sum < a.low ? 1 : 0)};
  }
  Int192 operator-() const { return {~low + 1, ~high + (low == 0 ? 1 : 0)}; }
  int sign() const { return high < 0 ? -1 : (high != 0 || low != 0) ? 1 : 0; }
};

// REQUIRES: |a| < 2^126, |b| < 2^62.
inline Int192 wide_product(Int128 a, std::int64_t b) {
  const Int128 low = static_cast<Int128>(static_cast<std::uint64_t>(a)) * b;
  const Int128 high = static_cast<Int128>(static_cast<std::int64_t>(a >> 64)) * b;
  return {static_cast<std::uint64_t>(low), high + (low >> 64)};
}

inline Int128 wide_minor(const Integers3& a, const Integers3& b) {
  return static_cast<Int128>(a[0]) * b[1] - static_cast<Int128>(a[1]) * b[0];
}

// det(a, b, c) from the minors of their first two coordinates. Below 2^189.
inline Int192 wide_determinant(const Integers3& a, Int128 bc, const Integers3& b, Int128 ac,
                               const Integers3& c, Int128 ab) {
  return wide_product(bc, a[2]) + wide_product(-ac, b[2]) + wide_product(ab, c[2]);
}

inline int wide_orient_sign(const Integers3& a, const Integers3& b, const Integers3& c) {
  return wide_determinant(a, wide_minor(b, c), b, wide_minor(a, c), c, wide_minor(a, b)).sign();
}

// A sum of products of a determinant and a lift, below 2^319.
class Int320 {
 public:
  // REQUIRES: 0 <= factor < 2^126.
  void add_product(Int192 value, UInt128 factor) {
    const bool negative = value.high < 0;
    if (negative) value = -value;
    const std::array<std::uint64_t, 3> a = {value.low, static_cast<std::uint64_t>(value.high),
                                            static_cast<std::uint64_t>(value.high >> 64)};
    const std::array<std::uint64_t, 2> b = {static_cast<std::uint64_t>(factor),
                                            static_cast<std::uint64_t>(factor >> 64)};
    std::array<std::uint64_t, 5> product = {};
    for (std::size_t j = 0; j < 2; ++j) {
      std::uint64_t carry = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const UInt128 sum = static_cast<UInt128>(a[i]) * b[j] + product[i + j] + carry;
        product[i + j] = static_cast<std::uint64_t>(sum);
        carry = static_cast<std::uint64_t>(sum >> 64);
      }
      product[j + 3] = carry;
    }
    // Two's complement: the negative is the complement plus one.
    const std::uint64_t flip = negative ? ~std::uint64_t{0} : 0;
    std::uint64_t carry = negative ? 1 : 0;
    for (std::size_t i = 0; i < 5; ++i) {
      const UInt128 sum = static_cast<UInt128>(words_[i]) + (product[i] ^ flip) + carry;
      words_[i] = static_cast<std::uint64_t>(sum);
      carry = static_cast<std::uint64_t>(sum >> 64);
    }
  }
  int sign() const {
    if (static_cast<std::int64_t>(words_[4]) < 0) return -1;
    return (words_[0] | words_[1] | words_[2] | words_[3] | words_[4]) != 0 ? 1 : 0;
  }

 private:
  std::array<std::uint64_t, 5> words_ = {};
};

inline UInt128 wide_lift(const Integers3& p) {
  const auto square = [](std::int64_t x) {
    return static_cast<UInt128>(static_cast<Int128>(x) * x);
  };
  return square(p[0]) + square(p[1]) + square(p[2]);
}

// The sign of insphere_determinant (determinants.h).
inline int wide_insphere_sign(const Integers3& a, const Integers3& b, const Integers3& c,
                              const Integers3& d) {
  const Int128 ab = wide_minor(a, b), ac = wide_minor(a, c), ad = wide_minor(a, d);
  const Int128 bc = wide_minor(b, c), bd = wide_minor(b, d), cd = wide_minor(c, d);
  Int320 sum;
  sum.add_product(wide_determinant(b, cd, c, bd, d, bc), wide_lift(a));
  sum.add_product(-wide_determinant(a, cd, c, ad, d, ac), wide_lift(b));
  sum.add_product(wide_determinant(a, bd, b, ad, d, ab), wide_lift(c));
  sum.add_product(-wide_determinant(a, bc, b, ac, c, ab), wide_lift(d));
  return sum.sign();
}

}  // namespace delray::delaunay::internal
