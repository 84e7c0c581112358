// What tests that meet every method leave out.
#pragma once

#include <cstddef>
#include <string_view>

#include "delaunay/methods.h"

namespace delray::delaunay {

// The size of a set of a kind of hard_points() among others of n: coordinates "of all sizes" are
// numbers of thousands of bits, with which everything takes long.
inline std::size_t size_for(std::string_view kind, std::size_t n) {
  return kind == "of all sizes" ? (n + 3) / 4 : n;
}

// Whether a slow method would take seconds for so many points of a kind of
// hard_points(); small sets show whether it is right. Coordinates "of all sizes" are numbers of
// thousands of bits.
inline bool takes_long(const Method& method, std::size_t points, std::string_view kind) {
  return method.slow && points > (kind == "of all sizes" ? 60 : 200);
}

}  // namespace delray::delaunay
