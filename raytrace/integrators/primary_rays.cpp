// Rays from the camera through sixteen pixels, by vectors: perspective, orthographic, and through a
// thin lens. Degenerate: no component of a direction is exactly 0, since a ray along an axis could
// pass between boxes that only touch.
#include "raytrace/integrators/primary_rays.h"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/integrators/primary_rays.cpp"
#include <hwy/foreach_target.h>
// Code that is compiled per target comes after it.
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

// No ray runs exactly along an axis: it could pass between boxes that only touch. What a thousandth
// of a pixel is to a ray is added.
HWY_INLINE F off_axis(F component, F length) {
  const F least = length * set(1e-6F);
  return hn::IfThenElse(hn::Lt(hn::Abs(component), least), least, component);
}

// Of the column and the row of blocks that begin at pixel (x, y).
void primary_step(const scenes::View& view, int x, int y, const PrimaryPlaces& places,
                  shading::Floats16& right, shading::Floats16& up) {
  const IntTag di;
  const F scale = set(view.scale);
  for (int i = 0; i < kPacketRays; i += lanes()) {
    const F column = to_float(hn::Load(di, kColumns + i) + set(x)) + load(places.x, i);
    const F row = to_float(hn::Load(di, kRows + i) + set(y)) + load(places.y, i);
    put((column - set(view.half_width)) / scale, right.lane + i);
    put((row - set(view.half_height)) / scale, up.lane + i);
  }
}

void primary_block(const scenes::View& view, const PrimaryBlock& block, RayGroup& group) {
  const IntTag di;
  const PrimaryPlaces& places = block.places;
  RayPacket& packet = group.packet;
  const F zero = set(0.0F);
  const I none = set(-1);
  const bool one_origin = !view.orthographic && !(view.lens_radius > 0.0F);
  for (int i = 0; i < kPacketRays; i += lanes()) {
    const F right = load(block.right, i), up = load(block.up, i);
    F3 direction = set(view.forward), origin = set(view.eye);
    F3& moved = view.orthographic ? origin : direction;
    moved = moved + set(view.right) * right - set(view.up) * up;
    if (view.lens_radius > 0.0F) {
      const F radius = set(view.lens_radius);
      const F3 aside = set(view.right) * (load(places.lens_x, i) * radius) +
                       set(view.up) * (load(places.lens_y, i) * radius);
      origin = origin + aside;
      direction = direction - aside * set(1.0F / view.focus_distance);
    }
    const F length = hn::Sqrt(dot(direction, direction));
    direction = {off_axis(direction.x, length), off_axis(direction.y, length),
                 off_axis(direction.z, length)};
    const F3 unit = direction * (set(1.0F) / length);
    if (!(block.again && one_origin)) {
      put(origin.x, packet.origin_x + i);
      put(origin.y, packet.origin_y + i);
      put(origin.z, packet.origin_z + i);
    }
    put(direction.x, packet.direction_x + i);
    put(direction.y, packet.direction_y + i);
    put(direction.z, packet.direction_z + i);
    put(set(std::numeric_limits<float>::infinity()), packet.far + i);
    put(none, packet.triangle + i);
    put(none, packet.geometry + i);
    put(none, packet.instance + i);
    put(hn::Neg(unit.x), group.view.x.lane + i);
    put(hn::Neg(unit.y), group.view.y.lane + i);
    put(hn::Neg(unit.z), group.view.z.lane + i);
    hn::Store(hn::VecFromMask(di, hn::RebindMask(di, mask_of(block.mask, i))), di,
              group.active.ray + i);
    if (block.again) continue;
    put(set(view.near), packet.near + i);
    put(zero, packet.time + i);
    put(none, packet.mask + i);
    put(set(0), packet.id + i);
    put(set(0), packet.flags + i);
    put(set(view.first_width()), group.width.lane + i);
    put(set(view.spread()), group.spread.lane + i);
  }
  group.coherent = true;
  group.misses = false;
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raytrace
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raytrace {

HWY_EXPORT(primary_block);
HWY_EXPORT(primary_step);

void PrimarySteps::set(const scenes::View& view, const geometry::Rect& pixels,
                       const PrimaryPlaces& places) {
  const auto blocks = [](int count) {
    return static_cast<std::size_t>((count + kBlockSide - 1) / kBlockSide);
  };
  right.resize(blocks(pixels.width()));
  up.resize(blocks(pixels.height()));
  shading::Floats16 unused;
  for (std::size_t k = 0; k < std::max(right.size(), up.size()); ++k) {
    const int from = static_cast<int>(k) * kBlockSide;
    HWY_DYNAMIC_DISPATCH(primary_step)
    (view, pixels.x0 + from, pixels.y0 + from, places, k < right.size() ? right[k] : unused,
     k < up.size() ? up[k] : unused);
  }
}

void set_primary_rays(const scenes::View& view, const PrimaryBlock& block, RayGroup& group) {
  HWY_DYNAMIC_DISPATCH(primary_block)(view, block, group);
}

}  // namespace delray::raytrace
#endif
