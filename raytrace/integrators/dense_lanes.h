// Lanes that go on, put side by side, and from there behind those of a group that is being filled.
#pragma once

#include <array>
#include <cstddef>

#include "shading/points.h"

namespace delray::raytrace {

// Up to sixteen lanes of so many fields of 32 bits each, of any type. Lane i is element
// kFirst + i; what lies before and behind may hold anything.
template <std::size_t kFields>
struct DenseLanes {
  static constexpr int kFirst = shading::kBlockPoints;
  alignas(64) float field[kFields][3 * shading::kBlockPoints];
  int count = 0;
};

// Lanes [used, 16) of `first` and as many of `second` as are left over become those of `dense`;
// lanes behind them become 0: Embree looks at rays that take no part as well. Element f of each is
// where field f begins, aligned. REQUIRES: `second` is there if used + count > 16.
void append_lanes(const float* dense, std::size_t fields, int count, int used, float* const* first,
                  float* const* second);

template <std::size_t kFields>
void append_lanes(const DenseLanes<kFields>& dense, int used,
                  const std::array<float*, kFields>& first,
                  const std::array<float*, kFields>* second) {
  append_lanes(dense.field[0], kFields, dense.count, used, first.data(),
               second != nullptr ? second->data() : nullptr);
}

}  // namespace delray::raytrace
