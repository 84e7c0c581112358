// What tests that meet every method leave out.
#pragma once

#include <cstddef>
#include <string_view>

#include "delaunay/methods.h"

namespace delray::delaunay {

// Whether a method of quadratic time would take seconds for so many points of a kind of
// hard_points(); small sets show whether it is right. Coordinates "of all sizes" are numbers of
// thousands of bits.
inline bool takes_long(const Method& method, std::size_t points, std::string_view kind) {
  return method.quadratic && points > (kind == "of all sizes" ? 60 : 300);
}

}  // namespace delray::delaunay
