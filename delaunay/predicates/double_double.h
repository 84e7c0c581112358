// Numbers of about 106 bits: the unevaluated sum of two doubles (Dekker 1971).
//
// With u = 2^-53, a sum is off by at most 4 u^2 of the absolute values of its terms and a product
// by at most 8 u^2 of its absolute value.
#pragma once

#include "delaunay/predicates/expansion.h"

namespace delray::delaunay::internal {

struct DoubleDouble {
  double high, low;

  friend DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
    const TwoDoubles sum = two_sum(a.high, b.high);
    const TwoDoubles result = fast_two_sum(sum.high, sum.low + (a.low + b.low));
    return {result.high, result.low};
  }
  friend DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) {
    return a + DoubleDouble{-b.high, -b.low};
  }
  friend DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
    const TwoDoubles product = two_product(a.high, b.high);
    const TwoDoubles result =
        fast_two_sum(product.high, product.low + (a.high * b.low + a.low * b.high));
    return {result.high, result.low};
  }
};

}  // namespace delray::delaunay::internal
