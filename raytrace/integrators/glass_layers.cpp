// Evaluates panes in blocks of sixteen: points, surfaces, then Fresnel's equations and tint by
// vectors. Lanes beyond the last pane repeat the first one. Degenerate: total reflection lets
// nothing through.
#include "raytrace/integrators/glass_layers.h"

#include <algorithm>
#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/integrators/glass_layers.cpp"
#include <hwy/foreach_target.h>
// Code that is compiled per target comes after it.
#include <hwy/highway.h>

#include "raytrace/scene/hit_points.h"
#include "raytrace/scene/same_material.h"
#include "shading/batch.h"
#include "shading/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace delray::raytrace {
namespace HWY_NAMESPACE {

using namespace shading::HWY_NAMESPACE;

// refracted() of raytrace/sampling/optics.h: what is mirrored.
HWY_INLINE F mirrored_share(const F3& view, const F3& normal, F ratio) {
  const F one = set(1.0F), zero = set(0.0F);
  const F cosine = min_of(max_of(dot(normal, view), zero), one);
  const F squared = one - ratio * ratio * (one - cosine * cosine);
  const F other = hn::Sqrt(squared);
  const F parallel = (cosine - ratio * other) / (cosine + ratio * other);
  const F perpendicular = (ratio * cosine - other) / (ratio * cosine + other);
  return hn::IfThenElse(hn::Le(squared, zero), one,
                        set(0.5F) * (parallel * parallel + perpendicular * perpendicular));
}

void transmittance_block(const shading::Surfaces& s, const shading::Vectors16& views,
                         shading::Vectors16& transmittance) {
  const F one = set(1.0F);
  const FloatTag d;
  for (int i = 0; i < shading::kBlockPoints; i += lanes()) {
    const F share = clamp01(load(s.transmission, i)) * (one - clamp01(load(s.metallic, i)));
    const M front = hn::RebindMask(d, hn::Ne(hn::Load(IntTag(), s.front + i), set(0)));
    const F ior = load(s.ior, i);
    const F ratio = hn::IfThenElse(front, one / ior, ior);
    const F mirrored = mirrored_share(load(views, i), load(s.normal, i), ratio);
    const F alpha = load(s.alpha, i), past = one - alpha;
    const F3 through = load(s.tint, i) * (alpha * share * (one - mirrored));
    hn::Store(past + through.x, d, transmittance.x.lane + i);
    hn::Store(past + through.y, d, transmittance.y.lane + i);
    hn::Store(past + through.z, d, transmittance.z.lane + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raytrace
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raytrace {
namespace {

HWY_EXPORT(transmittance_block);

}  // namespace

void find_transmittances(std::span<const GeometryInstance> instances,
                         const shading::BatchShader& shader, std::span<const PaneHit> hits) {
  RayGroup group;
  shading::Surfaces surfaces;
  shading::Vectors16 transmittance;
  group.width = group.spread = {};
  for (; !hits.empty(); hits = hits.subspan(std::min<std::size_t>(hits.size(), kPacketRays))) {
    const int count = static_cast<int>(std::min<std::size_t>(hits.size(), kPacketRays));
    for (int i = 0; i < kPacketRays; ++i) {
      const PaneHit& pane = hits[static_cast<std::size_t>(i < count ? i : 0)];
      group.active.ray[i] = i < count ? -1 : 0;
      group.packet.far[i] = pane.hit.distance;
      group.packet.geometry[i] = pane.hit.instance;
      group.packet.instance[i] = kMiss;
      group.packet.triangle[i] = pane.hit.triangle;
      group.packet.u[i] = pane.hit.u;
      group.packet.v[i] = pane.hit.v;
      group.view.set(i, -pane.direction);
    }
    find_points(instances, group);
    for (shading::LaneMask rest = group.hits; rest != 0;) {
      const shading::LaneMask same = same_material(group, rest);
      shading::evaluate(shader, group.material[std::countr_zero(rest)], group.points, group.view,
                        same, surfaces);
      rest &= ~same;
    }
    HWY_DYNAMIC_DISPATCH(transmittance_block)(surfaces, group.view, transmittance);
    for (int i = 0; i < count; ++i)
      *hits[static_cast<std::size_t>(i)].transmittance = transmittance.get(i);
  }
}

}  // namespace delray::raytrace
#endif
