// Evaluates and draws from the lobes below coat and sheen, by vectors: diffuse, GGX reflection, and
// transmission through a rough interface (Walter et al. 2007), with visible normals (Heitz 2018;
// Dupuy and Benyoub 2023).
//
// The diffuse lobe is drawn with its share of the albedo, reflection against transmission by what
// either would carry. Densities and values come from the same functions, so that weights of samples
// agree with evaluation.
//
// Degenerate: smooth interfaces are deltas, which evaluation never finds; media of nearly one
// density let light straight through; the viewer is lifted above the horizon of the shading normal;
// directions on different sides of the two normals carry nothing.
#include "raytrace/sampling/base_bsdf.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/sampling/bsdf.cpp"
#include <hwy/foreach_target.h>
// Code that is compiled per target comes after it.
#include <hwy/highway.h>

#include "raytrace/sampling/warp_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace delray::raytrace {
namespace HWY_NAMESPACE {

// The least height of the viewer over the shading normal's horizon.
constexpr float kLowest = 1e-3F;

// Within this of 1 a ratio of indices bends light by less than a pixel.
constexpr float kSameDensity = 1e-3F;

// Directions closer than this to the plane of a normal belong to neither side.
constexpr float kLeastHeight = 1e-6F;

HWY_INLINE F mean(const F3& v) { return (v.x + v.y + v.z) * set(1.0F / 3.0F); }
HWY_INLINE bool none(M m) { return hn::AllFalse(FloatTag(), m); }

// The unit normal, or one between it and the viewer from which the viewer is above the horizon.
HWY_INLINE F3 towards(const F3& normal, const F3& view) {
  const F cosine = dot(normal, view);
  const F3 turned = normal + view * (set(2.0F * kLowest) - cosine);
  return choose(hn::Ge(cosine, set(kLowest)), normal,
                turned * (set(1.0F) / hn::Sqrt(dot(turned, turned))));
}

HWY_INLINE F3 schlick(const F3& specular, F grazing, F cosine) {
  const F rise = pow5(set(1.0F) - cosine);
  return {specular.x + (grazing - specular.x) * rise, specular.y + (grazing - specular.y) * rise,
          specular.z + (grazing - specular.z) * rise};
}

// Optics' refracted, with the viewer in the frame of the normal, at a cosine from 0 to 1.
struct RefractionLanes {
  F reflected;  // 1: nothing passes
  F bend;       // direction: normal * bend - view * ratio
};

HWY_INLINE RefractionLanes refraction(F cosine, F ratio) {
  const F one = set(1.0F);
  const F squared = one - ratio * ratio * (one - cosine * cosine);
  const F other = hn::Sqrt(max_of(squared, set(0.0F)));
  const F parallel = (cosine - ratio * other) / (cosine + ratio * other);
  const F perpendicular = (ratio * cosine - other) / (ratio * cosine + other);
  const F reflected = set(0.5F) * (parallel * parallel + perpendicular * perpendicular);
  return {hn::IfThenElse(hn::Gt(squared, set(0.0F)), reflected, one), ratio * cosine - other};
}

// One vector of Bsdfs.
struct BsdfLanes {
  FrameLanes frame;
  F3 geometric_normal, view, diffuse, specular, scale, transmitted;
  F grazing, alpha, glass, glass_scale, ratio, diffuse_share;
  M smooth, straight, thin, black;
  bool some_glass;
};

HWY_INLINE BsdfLanes loaded(const Bsdfs& b, int i, M active) {
  const F glass = load(b.glass, i);
  return {{load(b.x, i), load(b.y, i), load(b.z, i)},
          load(b.geometric_normal, i),
          load(b.view, i),
          load(b.diffuse, i),
          load(b.specular, i),
          load(b.scale, i),
          load(b.transmitted, i),
          load(b.grazing, i),
          load(b.alpha, i),
          glass,
          load(b.glass_scale, i),
          load(b.ratio, i),
          load(b.diffuse_share, i),
          mask_of(b.smooth, i),
          mask_of(b.straight, i),
          mask_of(b.thin, i),
          mask_of(b.black, i),
          !none(hn::And(active, hn::Gt(glass, set(0.0F))))};
}

// The interface's effect on light that meets it at a microscopic normal.
struct InterfaceLanes {
  F3 reflected, transmitted;
  F reflection_share;  // with which a ray is drawn that is reflected
};

HWY_INLINE InterfaceLanes interface_at(const BsdfLanes& b, F cosine) {
  const F one = set(1.0F), zero = set(0.0F);
  cosine = clamp01(cosine);
  InterfaceLanes result = {schlick(b.specular, b.grazing, cosine) * b.scale, set(glm::vec3(0.0F)),
                           one};
  if (!b.some_glass) return result;
  const M glass = hn::Gt(b.glass, zero);
  const F f = refraction(cosine, b.ratio).reflected;
  const F mirrored = f * b.glass_scale;
  const F3 reflected = mix(result.reflected, F3{mirrored, mirrored, mirrored}, b.glass);
  const F3 transmitted = b.transmitted * ((one - f) * b.glass_scale);
  const F r = mean(reflected), t = mean(transmitted);
  const M passes = hn::And(glass, hn::Gt(t, zero));
  return {choose(glass, reflected, result.reflected), where(glass, transmitted),
          hn::IfThenElse(passes, r / (r + t), one)};
}

// The share of light along v that a rough surface does not hide (Smith), times 2 over it:
// 1 + lambda.
HWY_INLINE F masking(F cosine, F a2) {
  const F one = set(1.0F);
  return set(0.5F) + set(0.5F) * hn::Sqrt(one + a2 * (one / (cosine * cosine) - one));
}

// The distribution of microscopic normals (GGX).
HWY_INLINE F distribution(const F3& half, F a2) {
  // half.z^2 (a2 - 1) + 1, with the digits that are left when half.z is close to 1.
  const F spread = half.x * half.x + half.y * half.y + half.z * half.z * a2;
  return a2 * set(shading::kInversePi) / (spread * spread);
}

// A microscopic normal with density distribution * dot(view, half) / (view.z * masking).
HWY_INLINE F3 visible_normal(const F3& view, F alpha, F u, F v) {
  const F one = set(1.0F);
  F3 stretched = {alpha * view.x, alpha * view.y, view.z};
  stretched = stretched * (one / hn::Sqrt(dot(stretched, stretched)));
  const F z = (one - v) * (one + stretched.z) - stretched.z;
  const F sine = hn::Sqrt(max_of(set(0.0F), one - z * z));
  const SinCosLanes phi = sin_cos(set(2.0F * shading::kPi) * u);
  const F3 sum = F3{sine * phi.cos, sine * phi.sin, z} + stretched;
  const F3 half = {alpha * sum.x, alpha * sum.y, max_of(sum.z, set(1e-7F))};
  return half * (one / hn::Sqrt(dot(half, half)));
}

struct ValueLanes {
  F3 value;
  F pdf;
};

HWY_INLINE ValueLanes where(M m, const ValueLanes& v) {
  return {where(m, v.value), hn::IfThenElseZero(m, v.pdf)};
}

// `light` in the frame, above it.
HWY_INLINE ValueLanes reflected_value(const BsdfLanes& b, const F3& light) {
  const F one = set(1.0F), n_l = light.z, n_v = b.view.z;
  const F3 diffuse = b.diffuse * n_l;
  const F diffuse_pdf = b.diffuse_share * n_l * set(shading::kInversePi);
  const F3 sum = b.view + light;
  const F length2 = max_of(dot(sum, sum), set(shading::kLeastSum));
  const F length = hn::Sqrt(length2);
  const F3 half = sum * (one / length);
  const F a2 = b.alpha * b.alpha;
  const InterfaceLanes at = interface_at(b, min_of(set(0.5F) * length, one));
  const F seen = masking(n_v, a2), lit = masking(n_l, a2);
  const F density = distribution(half, a2) / (set(4.0F) * n_v);
  const F3 specular = at.reflected * (density / (seen + lit - one));
  const F pdf = (one - b.diffuse_share) * at.reflection_share * density / seen;
  const M rough = hn::Not(b.smooth);
  return {diffuse + where(rough, specular), diffuse_pdf + hn::IfThenElseZero(rough, pdf)};
}

// `light` in the frame, below a thin pane.
HWY_INLINE ValueLanes passed_value(const BsdfLanes& b, const F3& light) {
  const F one = set(1.0F), n_v = b.view.z, n_l = hn::Neg(light.z);
  const F3 sum = b.view + F3{light.x, light.y, n_l};
  const F length2 = max_of(dot(sum, sum), set(shading::kLeastSum));
  const F length = hn::Sqrt(length2);
  const F a2 = b.alpha * b.alpha;
  const InterfaceLanes at = interface_at(b, min_of(set(0.5F) * length, one));
  const F seen = masking(n_v, a2), lit = masking(n_l, a2);
  const F density = distribution(sum * (one / length), a2) / (set(4.0F) * n_v);
  const M passes = hn::And(hn::Gt(b.glass, set(0.0F)), hn::Not(hn::Or(b.smooth, b.straight)));
  return where(passes,
               ValueLanes{at.transmitted * (density / (seen + lit - one)),
                          (one - b.diffuse_share) * (one - at.reflection_share) * density / seen});
}

// `light` in the frame, below it. The viewer's index of refraction is taken as `ratio`, the other
// as 1.
HWY_INLINE ValueLanes transmitted_value(const BsdfLanes& b, const F3& light) {
  const F one = set(1.0F), zero = set(0.0F);
  F3 half = b.view * b.ratio + light;
  const F length2 = dot(half, half);
  // On the viewer's side of the surface.
  half = half * hn::CopySign(one / hn::Sqrt(length2), half.z);
  const F v_h = dot(b.view, half), l_h = hn::Neg(dot(light, half));
  const F a2 = b.alpha * b.alpha;
  const InterfaceLanes at = interface_at(b, v_h);
  const F seen = masking(b.view.z, a2), lit = masking(hn::Neg(light.z), a2);
  // Density of the normal, as seen, times how fast it turns with the direction.
  const F density = distribution(half, a2) * v_h * l_h / (b.view.z * length2);
  const M bends = hn::And(hn::Gt(b.glass, zero), hn::Not(hn::Or(b.smooth, b.straight)));
  const M passes = hn::And(hn::And(hn::Gt(v_h, zero), hn::Gt(l_h, zero)),
                           hn::Gt(length2, set(shading::kLeastSum * kSameDensity)));
  return where(hn::And(bends, passes),
               ValueLanes{at.transmitted * (density / (seen + lit - one)),
                          (one - b.diffuse_share) * (one - at.reflection_share) * density / seen});
}

// The direction in the frame and in the world.
HWY_INLINE ValueLanes value_of(const BsdfLanes& b, const F3& local, const F3& world, M active) {
  const M fits = hn::Gt(dot(world, b.geometric_normal) * local.z, set(0.0F));
  const M above = hn::And(fits, hn::Gt(local.z, set(kLeastHeight)));
  ValueLanes result = where(above, reflected_value(b, local));
  const M below = hn::And(fits, hn::Lt(local.z, set(-kLeastHeight)));
  if (!b.some_glass || none(hn::And(active, below))) return result;
  ValueLanes other = transmitted_value(b, local);
  if (!none(hn::And(active, b.thin))) {
    const ValueLanes pane = passed_value(b, local);
    other = {choose(b.thin, pane.value, other.value), hn::IfThenElse(b.thin, pane.pdf, other.pdf)};
  }
  return {choose(below, other.value, result.value), hn::IfThenElse(below, other.pdf, result.pdf)};
}

shading::LaneMask bsdfs_block(const shading::Surfaces& s, const shading::Vectors16& views,
                              shading::LaneMask mask, Bsdfs& out) {
  const F one = set(1.0F), zero = set(0.0F);
  out.smooth = out.straight = out.black = 0;
  out.thin = s.thin & mask;
  shading::LaneMask rough_glass = 0;
  for (int i = 0; i < shading::kBlockPoints; i += lanes()) {
    const M active = mask_of(mask, i);
    if (none(active)) continue;
    const F3 to_viewer = load(views, i);
    const FrameLanes frame = frame_around(towards(load(s.normal, i), to_viewer));
    F3 view = frame.to_local(to_viewer);
    view.z = max_of(view.z, set(0.5F * kLowest));
    const F glass = clamp01(load(s.transmission, i)) * (one - clamp01(load(s.metallic, i)));
    const F3 transmitted = load(s.base_colour, i) * glass;
    const F ior = load(s.ior, i);
    const IntTag di;
    const M front = hn::RebindMask(FloatTag(), hn::Ne(hn::Load(di, s.front + i), set(0)));
    const F ratio = hn::IfThenElse(front, one / ior, ior);
    const M smooth = hn::Lt(load(s.lobe_roughness, i), set(shading::kMinRoughness));
    const F3 specular = load(s.specular, i);
    const F grazing = load(s.grazing, i);
    const F3 scale = load(s.scale, i);
    const F3 mirrored =
        choose(smooth, schlick(specular, grazing, clamp01(view.z)) * scale, load(s.mirrored, i));
    const F entering = load(s.entering, i);
    const F3 diffuse = load(s.diffuse, i) * entering;
    const F scattered = mean(diffuse);
    const F others = mean(mirrored) * (one - glass) + max_of(glass, mean(transmitted));
    const M black = hn::Not(hn::Gt(scattered + others, zero));
    store(frame.x, active, i, out.x);
    store(frame.y, active, i, out.y);
    store(frame.z, active, i, out.z);
    store(load(s.geometric_normal, i), active, i, out.geometric_normal);
    store(view, active, i, out.view);
    store(diffuse * set(shading::kInversePi), active, i, out.diffuse);
    store(specular, active, i, out.specular);
    store(scale, active, i, out.scale);
    store(grazing, active, i, out.grazing);
    store(load(s.lobe_alpha, i), active, i, out.alpha);
    store(transmitted, active, i, out.transmitted);
    store(glass, active, i, out.glass);
    store(one, active, i, out.glass_scale);
    store(ratio, active, i, out.ratio);
    store(hn::IfThenElse(black, one, scattered / (scattered + others)), active, i,
          out.diffuse_share);
    out.smooth |= bits_of(hn::And(active, smooth), i);
    const M straight = hn::Lt(hn::Abs(ratio - one), set(kSameDensity));
    out.straight |= bits_of(hn::And(active, straight), i);
    const M bends = hn::And(hn::Gt(glass, zero), hn::Not(hn::Or(smooth, straight)));
    rough_glass |= bits_of(hn::And(active, bends), i);
    out.black |= bits_of(hn::And(active, black), i);
  }
  return rough_glass;
}

void values_block(const Bsdfs& bsdfs, const shading::Vectors16& lights, shading::LaneMask mask,
                  BsdfValues& out) {
  for (int i = 0; i < shading::kBlockPoints; i += lanes()) {
    const M active = mask_of(mask, i);
    if (none(active)) continue;
    const BsdfLanes b = loaded(bsdfs, i, active);
    const F3 light = load(lights, i);
    const ValueLanes found = value_of(b, b.frame.to_local(light), light, active);
    store(found.value, active, i, out.value);
    store(found.pdf, active, i, out.pdf);
  }
}

void samples_block(const Bsdfs& bsdfs, const shading::Floats16& lobes, const shading::Floats16& us,
                   const shading::Floats16& vs, shading::LaneMask mask, BsdfSamples& out) {
  const F one = set(1.0F), zero = set(0.0F);
  out.transmitted = out.diffuse = 0;
  for (int i = 0; i < shading::kBlockPoints; i += lanes()) {
    const M active = mask_of(mask, i);
    if (none(active)) continue;
    const BsdfLanes b = loaded(bsdfs, i, active);
    const F lobe = load(lobes, i), u = load(us, i), v = load(vs, i);
    const M diffuse = hn::Lt(lobe, b.diffuse_share);
    F3 light = cosine_direction(u, v);
    M usable = hn::Or(diffuse, hn::Not(b.black)), deltas = hn::Lt(one, zero), through = deltas;
    F3 delta_weight = set(glm::vec3(0.0F));
    if (!hn::AllTrue(FloatTag(), hn::Or(diffuse, hn::Not(active)))) {
      // From a microscopic normal to a direction, or to none.
      const F others = one - b.diffuse_share;
      const F choice = min_of((lobe - b.diffuse_share) / others, set(1.0F - 0x1p-24F));
      const F3 half =
          choose(b.smooth, set(glm::vec3(0, 0, 1)), visible_normal(b.view, b.alpha, u, v));
      const F v_h = dot(b.view, half);
      const InterfaceLanes at = interface_at(b, v_h);
      const M passes = hn::Not(hn::Lt(choice, at.reflection_share));
      const M delta = hn::Or(b.smooth, hn::And(b.straight, passes));
      const RefractionLanes bent = refraction(clamp01(v_h), b.ratio);
      const F3 mirrored = half * (set(2.0F) * v_h) - b.view;
      F3 refracted = choose(b.straight, negated(b.view), half * bent.bend - b.view * b.ratio);
      refracted = choose(hn::AndNot(b.straight, b.thin),
                         F3{mirrored.x, mirrored.y, hn::Neg(mirrored.z)}, refracted);
      const F3 other = choose(passes, refracted, mirrored);
      const M dark =
          hn::Or(hn::Not(hn::Gt(v_h, zero)),
                 hn::And(passes, hn::And(hn::Not(b.straight), hn::Ge(bent.reflected, one))));
      const M on_side =
          hn::Gt(hn::IfThenElse(passes, hn::Neg(other.z), other.z), set(kLeastHeight));
      const F share = hn::IfThenElse(passes, one - at.reflection_share, at.reflection_share);
      delta_weight = choose(passes, at.transmitted, at.reflected) * (one / (share * others));
      light = choose(diffuse, light, other);
      usable = hn::And(usable, hn::Or(diffuse, hn::And(on_side, hn::Not(dark))));
      deltas = hn::And(delta, hn::Not(diffuse));
      through = hn::And(passes, hn::Not(diffuse));
    }
    const F3 world = b.frame.to_world(light);
    const ValueLanes found = value_of(b, light, world, active);
    const M fits = hn::Gt(dot(world, b.geometric_normal) * light.z, zero);
    const M drawn = hn::And(usable, hn::Gt(found.pdf, zero));
    const F3 weight = choose(deltas, where(hn::And(usable, fits), delta_weight),
                             where(drawn, found.value * (one / found.pdf)));
    store(world, active, i, out.direction);
    store(weight, active, i, out.weight);
    store(hn::IfThenElseZero(hn::And(usable, hn::Not(deltas)), found.pdf), active, i, out.pdf);
    out.transmitted |= bits_of(hn::And(active, through), i);
    out.diffuse |= bits_of(hn::And(active, diffuse), i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raytrace
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raytrace {

HWY_EXPORT(bsdfs_block);
HWY_EXPORT(values_block);
HWY_EXPORT(samples_block);

shading::LaneMask make_base_bsdfs(const shading::Surfaces& surfaces,
                                  const shading::Vectors16& views, shading::LaneMask lanes,
                                  Bsdfs& bsdfs) {
  return HWY_DYNAMIC_DISPATCH(bsdfs_block)(surfaces, views, lanes, bsdfs);
}

void evaluate_base(const Bsdfs& bsdfs, const shading::Vectors16& lights, shading::LaneMask lanes,
                   BsdfValues& values) {
  HWY_DYNAMIC_DISPATCH(values_block)(bsdfs, lights, lanes, values);
}

void sample_base(const Bsdfs& bsdfs, const shading::Floats16& lobe, const shading::Floats16& u,
                 const shading::Floats16& v, shading::LaneMask lanes, BsdfSamples& samples) {
  HWY_DYNAMIC_DISPATCH(samples_block)(bsdfs, lobe, u, v, lanes, samples);
}

}  // namespace delray::raytrace
#endif
