// shading/brdf.h over lanes. Compiled once per instruction set.
#if defined(DELRAY_SHADING_BRDF_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef DELRAY_SHADING_BRDF_LANES
#undef DELRAY_SHADING_BRDF_LANES
#else
#define DELRAY_SHADING_BRDF_LANES
#endif

#include "shading/batch_shader.h"
#include "shading/brdf.h"
#include "shading/lanes.h"
#include "shading/lanes/specular_table.h"

HWY_BEFORE_NAMESPACE();
namespace delray::shading {
namespace HWY_NAMESPACE {

// A reflectance: three channels, or one where all are equal.
struct Coloured {
  F3 v;
};
struct Grey {
  F v;
};

HWY_INLINE Coloured operator+(const Coloured& a, const Coloured& b) { return {a.v + b.v}; }
HWY_INLINE Coloured operator*(const Coloured& a, const Coloured& b) { return {a.v * b.v}; }
HWY_INLINE Coloured operator*(const Coloured& a, F b) { return {a.v * b}; }
HWY_INLINE F3 times(const F3& a, const Coloured& b) { return a * b.v; }
HWY_INLINE F3 plus(const F3& a, const Coloured& b) { return a + b.v; }
HWY_INLINE Grey operator+(const Grey& a, const Grey& b) { return {a.v + b.v}; }
HWY_INLINE Grey operator*(const Grey& a, const Grey& b) { return {a.v * b.v}; }
HWY_INLINE Grey operator*(const Grey& a, F b) { return {a.v * b}; }
HWY_INLINE F3 times(const F3& a, const Grey& b) { return a * b.v; }
HWY_INLINE F3 plus(const F3& a, const Grey& b) { return {a.x + b.v, a.y + b.v, a.z + b.v}; }

HWY_INLINE F brightest(const Coloured& a) { return max_of(max_of(a.v.x, a.v.y), a.v.z); }
HWY_INLINE F brightest(const Grey& a) { return a.v; }

// Lobes.
struct LobesLanes {
  F3 diffuse, specular;
  F grazing, alpha, roughness, metallic;
  F3 dielectric, metal;
  F dielectric_grazing, metal_grazing;
  F3 dielectric_again, metal_again;
};

// Of a material whose specular lobe is the same everywhere.
HWY_INLINE LobesLanes constant_lobes(const Lobes& l, const F3& diffuse) {
  return {diffuse,
          set(l.specular),
          set(l.grazing),
          set(l.alpha),
          set(l.roughness),
          set(l.metallic),
          set(l.dielectric),
          set(l.metal),
          set(l.dielectric_grazing),
          set(l.metal_grazing),
          set(l.dielectric_again),
          set(l.metal_again)};
}

// SpecularShares.
struct SharesLanes {
  F normal, grazing;
};

// Response.
template <class Reflectance>
struct ResponseLanes {
  Reflectance specular, scale;
  F entering;
};

// What is lost at the first meeting over what is not, by a white surface.
HWY_INLINE F lost_by(const SharesLanes& shares) {
  const F white = shares.normal + shares.grazing;
  return (set(1.0F) - white) / white;
}

// Of a grey dielectric.
HWY_INLINE ResponseLanes<Grey> grey_response(const Lobes& l, const SharesLanes& shares) {
  const F normal = set(l.dielectric.x), grazing = set(l.dielectric_grazing);
  const F once = normal * shares.normal + grazing * shares.grazing;
  const Grey scale{set(1.0F) + set(l.dielectric_again.x) * lost_by(shares)};
  const Grey specular = Grey{once} * scale;
  return {specular, scale, set(1.0F) - specular.v};
}

HWY_INLINE Coloured once(const F3& normal, F grazing, const SharesLanes& shares) {
  const F rest = grazing * shares.grazing;
  const F3 head_on = normal * shares.normal;
  return {{head_on.x + rest, head_on.y + rest, head_on.z + rest}};
}

HWY_INLINE Coloured scale_of(const F3& again, F lost) {
  const F one = set(1.0F);
  return {{one + again.x * lost, one + again.y * lost, one + again.z * lost}};
}

HWY_INLINE F share_of(F metal, F metallic, F all) {
  return metal * metallic / max_of(all, set(kLeastReflectance));
}

HWY_INLINE ResponseLanes<Coloured> response(const LobesLanes& l, const SharesLanes& shares) {
  const F lost = lost_by(shares);
  const Coloured dielectric_scale = scale_of(l.dielectric_again, lost);
  const Coloured below = once(l.dielectric, l.dielectric_grazing, shares) * dielectric_scale;
  const Coloured all = once(l.specular, l.grazing, shares);
  const Coloured metal = once(l.metal, l.metal_grazing, shares);
  const Coloured metal_scale = scale_of(l.metal_again, lost);
  const F3 share{share_of(metal.v.x, l.metallic, all.v.x), share_of(metal.v.y, l.metallic, all.v.y),
                 share_of(metal.v.z, l.metallic, all.v.z)};
  const Coloured scale{dielectric_scale.v + (metal_scale.v - dielectric_scale.v) * share};
  return {all * scale, scale, set(1.0F) - brightest(below)};
}

// What reflect() looks at.
template <class Reflectance>
struct LobeLanes {
  F3 diffuse;            // Lobes::diffuse times Response::entering over pi
  Reflectance specular;  // Lobes::specular
  Reflectance rise;      // from there to Lobes::grazing
  Reflectance scale;     // Response::scale
  F a2;                  // Lobes::alpha squared
  F n_v, root;           // of the viewer
};

template <class Reflectance>
HWY_INLINE LobeLanes<Reflectance> seen_lobes(const F3& diffuse, F entering,
                                             const Reflectance& specular, const Reflectance& rise,
                                             const Reflectance& scale, F alpha, F facing) {
  const F a2 = alpha * alpha;
  const F n_v = max_of(facing, set(kLeastCosine));
  return {diffuse * (entering * set(kInversePi)),     specular, rise, scale, a2, n_v,
          hn::Sqrt(n_v * n_v * (set(1.0F) - a2) + a2)};
}

HWY_INLINE LobeLanes<Grey> seen_lobes(const Lobes& l, const F3& diffuse,
                                      const ResponseLanes<Grey>& response, F facing) {
  return seen_lobes<Grey>(diffuse, response.entering, {set(l.specular.x)},
                          {set(l.grazing - l.specular.x)}, response.scale, set(l.alpha), facing);
}
HWY_INLINE LobeLanes<Coloured> seen_lobes(const LobesLanes& l,
                                          const ResponseLanes<Coloured>& response, F facing) {
  const F3 rise{l.grazing - l.specular.x, l.grazing - l.specular.y, l.grazing - l.specular.z};
  return seen_lobes<Coloured>(l.diffuse, response.entering, {l.specular}, {rise}, response.scale,
                              l.alpha, facing);
}

template <class Reflectance>
HWY_INLINE F3 reflect(const LobeLanes<Reflectance>& lobes, const F3& normal, const F3& view,
                      const F3& light) {
  const F one = set(1.0F), a2 = lobes.a2;
  const F n_l = dot(normal, light);
  const F3 sum = view + light;
  const F length2 = max_of(dot(sum, sum), set(kLeastSum));
  const F v_h = min_of(set(0.5F) * hn::Sqrt(length2), one);
  const F along = max_of(dot(normal, sum), set(0.0F));
  const F along2 = min_of(along * along, length2);
  const F spread = (length2 - along2) + along2 * a2;
  const F shadowing = n_l * lobes.root + lobes.n_v * hn::Sqrt(n_l * n_l * (one - a2) + a2);
  const F peak = a2 * set(0.5F * kInversePi) * (length2 * length2) / (spread * spread * shadowing);
  const Reflectance fresnel = lobes.specular + lobes.rise * pow5(one - v_h);
  return where(hn::Gt(n_l, set(0.0F)), plus(lobes.diffuse, fresnel * lobes.scale * peak) * n_l);
}

// Element `at` of sixteen.
HWY_INLINE F look_up(const float* table, I at) {
  const FloatTag d;
  if constexpr (hn::MaxLanes(FloatTag()) == kBlockPoints) {
    return hn::TableLookupLanes(hn::Load(d, table), hn::IndicesFromVec(d, at));
  } else if constexpr (2 * hn::MaxLanes(FloatTag()) == kBlockPoints) {
    const I half = set(kBlockPoints / 2);
    const auto index = hn::IndicesFromVec(d, at & (half - set(1)));
    const F low = hn::TableLookupLanes(hn::Load(d, table), index);
    const F high = hn::TableLookupLanes(hn::Load(d, table + kBlockPoints / 2), index);
    return hn::IfThenElse(hn::RebindMask(d, hn::Lt(at, half)), low, high);
  } else {
    return hn::GatherIndex(d, table, at);
  }
}

// again() for one channel.
HWY_INLINE F again(F normal, F grazing, F mean_albedo) {
  const F one = set(1.0F);
  const F mean = min_of(normal + (grazing - normal) * set(1.0F / 21.0F), one);
  return mean * mean_albedo / (one - mean * (one - mean_albedo));
}
HWY_INLINE F3 again(const F3& normal, F grazing, F mean_albedo) {
  return {again(normal.x, grazing, mean_albedo), again(normal.y, grazing, mean_albedo),
          again(normal.z, grazing, mean_albedo)};
}

struct RoughnessAt {
  I row;
  F rest;
};

HWY_INLINE RoughnessAt roughness_at(F roughness) {
  const F y = roughness * set(static_cast<float>(SpecularTable::kRoughnesses - 1));
  const I row = hn::Min(truncated(y), set(SpecularTable::kRoughnesses - 2));
  return {row, y - to_float(row)};
}

HWY_INLINE F mean_albedo(F roughness) {
  const FloatTag d;
  const RoughnessAt at = roughness_at(roughness);
  const float* const means = specular_table().mean;
  return mix(hn::GatherIndex(d, means, at.row), hn::GatherIndex(d, means, at.row + set(1)),
             at.rest);
}

struct CosineAt {
  I column;
  F rest;
};

// `cosine` from 0 to 1.
HWY_INLINE CosineAt cosine_at(F cosine) {
  const F x = hn::Sqrt(cosine) * set(static_cast<float>(SpecularTable::kCosines - 1));
  const I column = hn::Min(truncated(x), set(SpecularTable::kCosines - 2));
  return {column, x - to_float(column)};
}

// specular_shares of a material whose roughness is the same everywhere.
HWY_INLINE SharesLanes constant_shares(const BatchMaterial& material, F cosine) {
  const CosineAt at = cosine_at(cosine);
  const auto share = [&](const float* low, const float* step) {
    return look_up(low, at.column) + look_up(step, at.column) * at.rest;
  };
  return {share(material.normal, material.normal_step),
          share(material.grazing, material.grazing_step)};
}

HWY_INLINE F between_rows(const float* table, I low, F v) {
  const FloatTag d;
  return mix(hn::GatherIndex(d, table, low),
             hn::GatherIndex(d, table, low + set(SpecularTable::kCosines)), v);
}

HWY_INLINE SharesLanes varying_shares(F roughness, F cosine) {
  const SpecularTable& table = specular_table();
  const CosineAt at = cosine_at(cosine);
  const RoughnessAt of = roughness_at(roughness);
  const F rest = of.rest;
  const I low = of.row * set(SpecularTable::kCosines) + at.column, high = low + set(1);
  const auto share = [&](const float* values) {
    return mix(between_rows(values, low, rest), between_rows(values, high, rest), at.rest);
  };
  return {share(&table.normal[0][0]), share(&table.grazing[0][0])};
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::shading
HWY_AFTER_NAMESPACE();

#endif
