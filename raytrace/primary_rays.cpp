#include "raytrace/internal/primary_rays.h"

#include <bit>
#include <limits>

#include "raytrace/samples.h"
#include "shading/targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/primary_rays.cpp"
#include <hwy/foreach_target.h>
// What is compiled per target comes after it.
#include <hwy/highway.h>

#include "shading/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace delray::raytrace {
namespace HWY_NAMESPACE {

using namespace shading::HWY_NAMESPACE;

HWY_ALIGN constexpr std::int32_t kColumns[kPacketRays] = {0, 1, 2, 3, 0, 1, 2, 3,
                                                          0, 1, 2, 3, 0, 1, 2, 3};
HWY_ALIGN constexpr std::int32_t kRows[kPacketRays] = {0, 0, 0, 0, 1, 1, 1, 1,
                                                       2, 2, 2, 2, 3, 3, 3, 3};

HWY_INLINE void put(F v, float* to) { hn::Store(v, FloatTag(), to); }
HWY_INLINE void put(I v, std::uint32_t* to) {
  hn::Store(v, IntTag(), reinterpret_cast<std::int32_t*>(to));
}

// The block at (x, y), samples at `offset` from the corners of its pixels.
void primary_block(const scenes::View& view, int x, int y, const glm::vec2& offset,
                   shading::LaneMask mask, RayGroup& group) {
  const IntTag di;
  RayPacket& packet = group.packet;
  const F zero = set(0.0F), scale = set(view.scale);
  const I none = set(-1);
  for (int i = 0; i < kPacketRays; i += lanes()) {
    const F column = to_float(hn::Load(di, kColumns + i) + set(x)) + set(offset.x);
    const F row = to_float(hn::Load(di, kRows + i) + set(y)) + set(offset.y);
    const F right = (column - set(view.half_width)) / scale;
    const F up = (row - set(view.half_height)) / scale;
    const F3 direction = set(view.forward) + set(view.right) * right - set(view.up) * up;
    const F length = hn::Sqrt(dot(direction, direction));
    const F3 unit = direction * (set(1.0F) / length);
    put(set(view.eye.x), packet.origin_x + i);
    put(set(view.eye.y), packet.origin_y + i);
    put(set(view.eye.z), packet.origin_z + i);
    put(set(view.near), packet.near + i);
    put(direction.x, packet.direction_x + i);
    put(direction.y, packet.direction_y + i);
    put(direction.z, packet.direction_z + i);
    put(zero, packet.time + i);
    put(set(std::numeric_limits<float>::infinity()), packet.far + i);
    put(none, packet.mask + i);
    put(set(0), packet.id + i);
    put(set(0), packet.flags + i);
    put(none, packet.triangle + i);
    put(none, packet.geometry + i);
    put(none, packet.instance + i);
    put(hn::Neg(unit.x), group.view.x.lane + i);
    put(hn::Neg(unit.y), group.view.y.lane + i);
    put(hn::Neg(unit.z), group.view.z.lane + i);
    put(zero, group.width.lane + i);
    put(set(1.0F / view.scale), group.spread.lane + i);
    hn::Store(hn::VecFromMask(di, hn::RebindMask(di, mask_of(mask, i))), di, group.active.ray + i);
  }
  group.coherent = true;
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raytrace
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raytrace {
namespace {

HWY_EXPORT(primary_block);

// Lanes of the block at (x, y) that are pixels of the task.
shading::LaneMask inside(const geometry::Rect& pixels, int x, int y) {
  if (x + kBlockSide <= pixels.x1 && y + kBlockSide <= pixels.y1) return shading::kAllLanes;
  shading::LaneMask mask = 0;
  for (int i = 0; i < kPacketRays; ++i) {
    mask |= pixels.contains(x + i % kBlockSide, y + i / kBlockSide) ? 1U << i : 0U;
  }
  return mask;
}

}  // namespace

std::uint64_t ask_primary_rays(const Setting& setting, const Task& task, Groups<RayGroup>& groups) {
  std::uint64_t count = 0;
  for (int s = 0; s < task.samples; ++s) {
    const glm::vec2 offset = sample_position(task.first_sample + s, setting.samples);
    for (int y = task.pixels.y0; y < task.pixels.y1; y += kBlockSide) {
      for (int x = task.pixels.x0; x < task.pixels.x1; x += kBlockSide) {
        const shading::LaneMask mask = inside(task.pixels, x, y);
        count += static_cast<std::uint64_t>(std::popcount(mask));
        HWY_DYNAMIC_DISPATCH(primary_block)
        (setting.view, x, y, offset, mask, groups.add());
      }
    }
  }
  return count;
}

}  // namespace delray::raytrace
#endif
