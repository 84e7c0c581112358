// Adds, copies, selects and negates lanes by vectors, compiled for each instruction set that
// Highway targets.
#include "raytrace/integrators/lane_sums.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/integrators/lane_sums.cpp"
#include <hwy/foreach_target.h>
// Code that is compiled per target comes after it.
#include <hwy/highway.h>

#include "shading/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace delray::raytrace {
namespace HWY_NAMESPACE {

using namespace shading::HWY_NAMESPACE;

void add_block(const shading::Vectors16& radiance, shading::LaneMask mask,
               shading::Vectors16& sums) {
  for (int i = 0; i < shading::kBlockPoints; i += lanes()) {
    const M active = mask_of(mask, i);
    store(load(sums, i) + load(radiance, i), active, i, sums);
  }
}

void copy_block(const shading::Vectors16& from, shading::LaneMask mask, shading::Vectors16& to) {
  for (int i = 0; i < shading::kBlockPoints; i += lanes()) {
    store(load(from, i), mask_of(mask, i), i, to);
  }
}

void choose_block(const float* from, float otherwise, shading::LaneMask mask,
                  shading::Floats16& to) {
  const FloatTag d;
  for (int i = 0; i < shading::kBlockPoints; i += lanes()) {
    hn::Store(hn::IfThenElse(mask_of(mask, i), hn::Load(d, from + i), set(otherwise)), d,
              to.lane + i);
  }
}

void negate_block(const shading::Vectors16& from, shading::Vectors16& to) {
  const FloatTag d;
  for (int i = 0; i < shading::kBlockPoints; i += lanes()) {
    hn::Store(hn::Neg(load(from.x, i)), d, to.x.lane + i);
    hn::Store(hn::Neg(load(from.y, i)), d, to.y.lane + i);
    hn::Store(hn::Neg(load(from.z, i)), d, to.z.lane + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raytrace
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raytrace {

HWY_EXPORT(add_block);
HWY_EXPORT(copy_block);
HWY_EXPORT(choose_block);
HWY_EXPORT(negate_block);

void add_lanes(const shading::Vectors16& radiance, shading::LaneMask mask,
               shading::Vectors16& sums) {
  HWY_DYNAMIC_DISPATCH(add_block)(radiance, mask, sums);
}

void copy_lanes(const shading::Vectors16& from, shading::LaneMask mask, shading::Vectors16& to) {
  HWY_DYNAMIC_DISPATCH(copy_block)(from, mask, to);
}

void choose_lanes(const float* from, float otherwise, shading::LaneMask mask,
                  shading::Floats16& to) {
  HWY_DYNAMIC_DISPATCH(choose_block)(from, otherwise, mask, to);
}

void negate_lanes(const shading::Vectors16& from, shading::Vectors16& to) {
  HWY_DYNAMIC_DISPATCH(negate_block)(from, to);
}

}  // namespace delray::raytrace
#endif
