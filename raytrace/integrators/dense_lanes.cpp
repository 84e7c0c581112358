// Moves packed lanes behind those of a group that is partly filled, and what is left over to a
// second one, by vectors, field by field.
#include "raytrace/integrators/dense_lanes.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/integrators/dense_lanes.cpp"
#include <hwy/foreach_target.h>
// Code that is compiled per target comes after it.
#include <hwy/highway.h>

#include "shading/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace delray::raytrace {
namespace HWY_NAMESPACE {

using namespace shading::HWY_NAMESPACE;

void append_block(const float* dense, std::size_t fields, int count, int used, float* const* first,
                  float* const* second) {
  const FloatTag d;
  constexpr int kLanes = shading::kBlockPoints;
  const int all = used + count;
  const shading::LaneMask in_first = shading::first_lanes(std::min(all, kLanes));
  const shading::LaneMask in_second = shading::first_lanes(std::max(all - kLanes, 0));
  for (std::size_t f = 0; f < fields; ++f, dense += 3 * kLanes) {
    for (int i = 0; i < kLanes; i += lanes()) {
      const M kept = mask_of(shading::first_lanes(used), i);
      const F fresh =
          hn::IfThenElseZero(mask_of(in_first, i), hn::LoadU(d, dense + kLanes - used + i));
      hn::Store(hn::IfThenElse(kept, hn::Load(d, first[f] + i), fresh), d, first[f] + i);
      if (second == nullptr) continue;
      const F left = hn::LoadU(d, dense + 2 * kLanes - used + i);
      hn::Store(hn::IfThenElseZero(mask_of(in_second, i), left), d, second[f] + i);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raytrace
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raytrace {

HWY_EXPORT(append_block);

void append_lanes(const float* dense, std::size_t fields, int count, int used, float* const* first,
                  float* const* second) {
  HWY_DYNAMIC_DISPATCH(append_block)(dense, fields, count, used, first, second);
}

}  // namespace delray::raytrace
#endif
