// Weights of lights and the environment, shadow rays and scattered rays of sixteen path vertices,
// by vectors; lanes that go on are compressed behind each other. Degenerate: weights that are zero
// or not finite end a path.
#include "raytrace/integrators/path_vertices.h"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/integrators/path_vertices.cpp"
#include <hwy/foreach_target.h>
// Code that is compiled per target comes after it.
#include <hwy/highway.h>

#include "raytrace/integrators/enqueue.h"
#include "raytrace/sampling/warp_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace delray::raytrace {
namespace HWY_NAMESPACE {

HWY_INLINE F brightest(const F3& v) { return max_of(max_of(v.x, v.y), v.z); }

HWY_INLINE M finite(const F3& v) {
  const F most = set(std::numeric_limits<float>::infinity());
  return hn::And(hn::Lt(hn::Abs(v.x), most),
                 hn::And(hn::Lt(hn::Abs(v.y), most), hn::Lt(hn::Abs(v.z), most)));
}

HWY_INLINE I word(const std::uint32_t* words, int i) {
  return hn::Load(IntTag(), reinterpret_cast<const std::int32_t*>(words) + i);
}

// Puts the lanes of a mask behind those that are there already, field after field.
template <class Dense>
class Appending {
 public:
  HWY_INLINE Appending(M mask, Dense& to) : mask_(mask), to_(to) {}
  HWY_INLINE ~Appending() { to_.count += static_cast<int>(hn::CountTrue(FloatTag(), mask_)); }
  HWY_INLINE void add(F v) {
    hn::StoreU(hn::Compress(v, mask_), FloatTag(), to_.field[field_++] + Dense::kFirst + to_.count);
  }
  HWY_INLINE void add(I v) { add(hn::BitCast(FloatTag(), v)); }
  HWY_INLINE void add(const F3& v) {
    add(v.x);
    add(v.y);
    add(v.z);
  }

 private:
  M mask_;
  Dense& to_;
  int field_ = 0;
};

shading::LaneMask emissive_block(const shading::Surfaces& surfaces, shading::LaneMask hits) {
  shading::LaneMask emissive = 0;
  for (int i = 0; i < shading::kBlockPoints; i += lanes()) {
    emissive |= bits_of(any_positive(load(surfaces.emission, i)), i);
  }
  return emissive & hits;
}

void weigh_sky_block(const PathLanes& from, const shading::Floats16& pdfs,
                     shading::Vectors16& radiance) {
  const FloatTag d;
  for (int i = 0; i < shading::kBlockPoints; i += lanes()) {
    const F pdf = load(from.pdf, i);
    const F share =
        hn::IfThenElse(hn::Gt(pdf, set(0.0F)), power_heuristic(pdf, load(pdfs, i)), set(1.0F));
    const F3 weighed = load(from.throughput, i) * load(radiance, i) * share;
    hn::Store(weighed.x, d, radiance.x.lane + i);
    hn::Store(weighed.y, d, radiance.y.lane + i);
    hn::Store(weighed.z, d, radiance.z.lane + i);
  }
}

shading::LaneMask light_rays_block(const Vertices& at, const LightSamples& lights,
                                   const BsdfValues& values, shading::LaneMask mask,
                                   LightRays& rays) {
  const F zero = set(0.0F), one = set(1.0F);
  shading::LaneMask asked = 0;
  rays.count = 0;
  for (int i = 0; i < shading::kBlockPoints; i += lanes()) {
    const M active = mask_of(mask, i);
    const F pdf = load(lights.pdf, i);
    const F share =
        hn::IfThenElse(hn::Gt(pdf, zero), power_heuristic(pdf, load(values.pdf, i)), one);
    const F3 reflected =
        load(at.lanes.throughput, i) * load(values.value, i) * load(lights.weight, i) * share;
    const M asks = hn::And(active, any_positive(reflected));
    if (hn::AllFalse(FloatTag(), asks)) continue;
    asked |= bits_of(asks, i);
    const F3 direction = load(lights.direction, i), up = load(at.surfaces.geometric_normal, i);
    const F offset = load(at.group.offset, i);
    const F away = hn::IfThenElse(hn::Ge(dot(direction, up), zero), offset, hn::Neg(offset));
    Appending<LightRays> append(asks, rays);
    append.add(load(at.surfaces.position, i) + up * away);
    append.add(direction);
    append.add(load(lights.distance, i) * set(kShadowReach));
    append.add(reflected);
    append.add(word(at.lanes.pixel, i));
  }
  return asked;
}

// A cone of the directions that are drawn with about the density of this one, as a ratio of width
// and distance; wide enough for textures to be read from small levels, never all of the sphere.
HWY_INLINE F spread_after(F spread, F pdf) {
  constexpr float kWidest = 0.25F;
  const F wide = max_of(spread, min_of(set(kWidest), set(0.25F) / hn::Sqrt(pdf)));
  return hn::IfThenElse(hn::Gt(pdf, set(0.0F)), wide, spread);
}

void scattered_block(const Vertices& at, const BsdfSamples& samples, const shading::Floats16& luck,
                     std::uint32_t certain, shading::LaneMask mask, ScatteredRays& rays) {
  const FloatTag d;
  const F one = set(1.0F);
  rays.count = 0;
  for (int i = 0; i < shading::kBlockPoints; i += lanes()) {
    F3 weight = load(at.lanes.throughput, i) * load(samples.weight, i);
    M goes_on = hn::And(mask_of(mask, i), hn::And(any_positive(weight), finite(weight)));
    const I bounce = word(at.lanes.bounce, i);
    const I scatterings = hn::ShiftRight<16>(bounce) + (bounce & set(0xFFFF));
    const M tried =
        hn::RebindMask(d, hn::Gt(scatterings, set(static_cast<std::int32_t>(certain) - 1)));
    const F chance = min_of(brightest(weight), one);
    goes_on = hn::And(goes_on, hn::Or(hn::Not(tried), hn::Lt(load(luck, i), chance)));
    if (hn::AllFalse(d, goes_on)) continue;
    weight = choose(tried, weight * (one / chance), weight);
    const F offset = load(at.group.offset, i);
    const F away = hn::IfThenElse(mask_of(samples.transmitted, i), hn::Neg(offset), offset);
    const F3 direction = load(samples.direction, i);
    const F pdf = load(samples.pdf, i), spread = load(at.group.spread, i);
    const F distance = hn::Load(d, at.group.packet.far + i);
    Appending<ScatteredRays> append(goes_on, rays);
    append.add(load(at.surfaces.position, i) + load(at.surfaces.geometric_normal, i) * away);
    append.add(direction);
    append.add(negated(direction));
    append.add(load(at.group.width, i) + distance * spread);
    append.add(spread_after(spread, pdf));
    append.add(weight);
    append.add(pdf);
    append.add(word(at.lanes.pixel, i));
    const I kind = hn::IfThenElse(hn::RebindMask(IntTag(), mask_of(samples.diffuse, i)),
                                  set(static_cast<std::int32_t>(kDiffuse)), set(1));
    append.add(bounce + kind);
    append.add(word(at.lanes.vertex, i) + set(1));
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raytrace
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raytrace {
namespace {

HWY_EXPORT(emissive_block);
HWY_EXPORT(weigh_sky_block);
HWY_EXPORT(light_rays_block);
HWY_EXPORT(scattered_block);

float* words(std::uint32_t* p) { return reinterpret_cast<float*>(p); }

}  // namespace

std::array<float*, 18> path_fields(RayGroup& group, PathLanes& lanes) {
  RayPacket& packet = group.packet;
  return {packet.origin_x,         packet.origin_y,         packet.origin_z,
          packet.direction_x,      packet.direction_y,      packet.direction_z,
          group.view.x.lane,       group.view.y.lane,       group.view.z.lane,
          group.width.lane,        group.spread.lane,       lanes.throughput.x.lane,
          lanes.throughput.y.lane, lanes.throughput.z.lane, lanes.pdf.lane,
          words(lanes.pixel),      words(lanes.bounce),     words(lanes.vertex)};
}

std::array<float*, 11> light_fields(ShadowGroup& group, LightLanes& lanes) {
  ShadowPacket& packet = group.packet;
  return {packet.origin_x,        packet.origin_y,        packet.origin_z,   packet.direction_x,
          packet.direction_y,     packet.direction_z,     packet.far,        lanes.reflected.x.lane,
          lanes.reflected.y.lane, lanes.reflected.z.lane, words(lanes.pixel)};
}

shading::LaneMask emissive_lanes(const shading::Surfaces& surfaces, shading::LaneMask hits) {
  return HWY_DYNAMIC_DISPATCH(emissive_block)(surfaces, hits);
}

void weigh_sky(const PathLanes& lanes, const shading::Floats16& pdfs,
               shading::Vectors16& radiance) {
  HWY_DYNAMIC_DISPATCH(weigh_sky_block)(lanes, pdfs, radiance);
}

shading::LaneMask rays_to_lights(const Vertices& vertices, const LightSamples& lights,
                                 const BsdfValues& values, shading::LaneMask mask,
                                 LightRays& rays) {
  return HWY_DYNAMIC_DISPATCH(light_rays_block)(vertices, lights, values, mask, rays);
}

void scattered_rays(const Vertices& vertices, const BsdfSamples& samples,
                    const shading::Floats16& luck, std::uint32_t certain, shading::LaneMask mask,
                    ScatteredRays& rays) {
  HWY_DYNAMIC_DISPATCH(scattered_block)(vertices, samples, luck, certain, mask, rays);
}

}  // namespace delray::raytrace
#endif
