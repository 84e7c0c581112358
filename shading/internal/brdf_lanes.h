// shading/brdf.h over lanes. Compiled once per instruction set.
#if defined(DELRAY_SHADING_BRDF_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef DELRAY_SHADING_BRDF_LANES
#undef DELRAY_SHADING_BRDF_LANES
#else
#define DELRAY_SHADING_BRDF_LANES
#endif

#include "shading/batch_shader.h"
#include "shading/brdf.h"
#include "shading/internal/specular_table.h"
#include "shading/lanes.h"

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
HWY_INLINE Coloured one_minus(const Coloured& a) {
  const F one = set(1.0F);
  return {{one - a.v.x, one - a.v.y, one - a.v.z}};
}
HWY_INLINE F3 times(const F3& a, const Coloured& b) { return a * b.v; }
HWY_INLINE F3 plus(const F3& a, const Coloured& b) { return a + b.v; }
HWY_INLINE Grey operator+(const Grey& a, const Grey& b) { return {a.v + b.v}; }
HWY_INLINE Grey operator*(const Grey& a, const Grey& b) { return {a.v * b.v}; }
HWY_INLINE Grey operator*(const Grey& a, F b) { return {a.v * b}; }
HWY_INLINE Grey one_minus(const Grey& a) { return {set(1.0F) - a.v}; }
HWY_INLINE F3 times(const F3& a, const Grey& b) { return a * b.v; }
HWY_INLINE F3 plus(const F3& a, const Grey& b) { return {a.x + b.v, a.y + b.v, a.z + b.v}; }

template <class Reflectance>
struct LobeLanes {
  F3 diffuse;            // Lobes::diffuse
  Reflectance entering;  // Lobes::entering over pi
  Reflectance specular;  // Lobes::specular
  Reflectance rise;      // from there to Lobes::grazing
  F grazing, roughness;
  F a2;                           // Lobes::alpha squared
  const BatchMaterial* constant;  // null: the specular lobe differs from lane to lane
};

HWY_INLINE Coloured reflectance(const glm::vec3& v, Coloured*) { return {set(v)}; }
HWY_INLINE Grey reflectance(const glm::vec3& v, Grey*) { return {set(v.x)}; }

// Of a material whose specular lobe is the same everywhere.
template <class Reflectance>
HWY_INLINE LobeLanes<Reflectance> constant_lobes(const BatchMaterial& material, const F3& diffuse) {
  const Lobes& l = material.lobes;
  Reflectance* const kind = nullptr;
  return {diffuse,
          reflectance(l.entering * kInversePi, kind),
          reflectance(l.specular, kind),
          reflectance(glm::vec3(l.grazing) - l.specular, kind),
          set(l.grazing),
          set(l.roughness),
          set(l.alpha * l.alpha),
          &material};
}

template <class Reflectance>
HWY_INLINE Reflectance fresnel(const LobeLanes<Reflectance>& lobes, F cosine) {
  return lobes.specular + lobes.rise * pow5(set(1.0F) - cosine);
}

// What depends on the viewer alone.
template <class Reflectance>
struct ViewTerms {
  F n_v, root;
  Reflectance out;
};

template <class Reflectance>
HWY_INLINE ViewTerms<Reflectance> view_terms(const LobeLanes<Reflectance>& lobes, F facing) {
  const F one = set(1.0F);
  const F n_v = max_of(facing, set(kLeastCosine));
  return {n_v, hn::Sqrt(n_v * n_v * (one - lobes.a2) + lobes.a2),
          one_minus(fresnel(lobes, min_of(n_v, one)))};
}

template <class Reflectance>
HWY_INLINE F3 reflect(const LobeLanes<Reflectance>& lobes, const ViewTerms<Reflectance>& viewer,
                      const F3& normal, const F3& view, const F3& light) {
  const F one = set(1.0F), a2 = lobes.a2;
  const F n_l = dot(normal, light);
  const F3 sum = view + light;
  const F length2 = max_of(dot(sum, sum), set(kLeastSum));
  const F v_h = min_of(set(0.5F) * hn::Sqrt(length2), one);
  const F along = max_of(dot(normal, sum), set(0.0F));
  const F along2 = min_of(along * along, length2);
  const F spread = (length2 - along2) + along2 * a2;
  const F shadowing = n_l * viewer.root + viewer.n_v * hn::Sqrt(n_l * n_l * (one - a2) + a2);
  const F peak = a2 * set(0.5F * kInversePi) * (length2 * length2) / (spread * spread * shadowing);
  const Reflectance specular = fresnel(lobes, v_h) * peak;
  const Reflectance in = one_minus(fresnel(lobes, min_of(n_l, one)));
  const F3 diffuse = times(times(lobes.diffuse, lobes.entering), in * viewer.out);
  return where(hn::Gt(n_l, set(0.0F)), plus(diffuse, specular) * n_l);
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

HWY_INLINE F albedo_channel(const BatchMaterial& material, int channel, I at, F u) {
  return look_up(material.albedo[channel], at) + look_up(material.albedo_step[channel], at) * u;
}
HWY_INLINE Coloured albedo(const BatchMaterial& material, I at, F u, Coloured*) {
  return {{albedo_channel(material, 0, at, u), albedo_channel(material, 1, at, u),
           albedo_channel(material, 2, at, u)}};
}
HWY_INLINE Grey albedo(const BatchMaterial& material, I at, F u, Grey*) {
  return {albedo_channel(material, 0, at, u)};
}

HWY_INLINE F between_rows(const float* table, I low, I high, F v) {
  const FloatTag d;
  return mix(hn::GatherIndex(d, table, low), hn::GatherIndex(d, table, high), v);
}

HWY_INLINE F3 specular_albedo_at(const F3& specular, F grazing, I row, I column, F v) {
  const SpecularTable& table = specular_table();
  const I low = row * set(SpecularTable::kCosines) + column;
  const I high = low + set(SpecularTable::kCosines);
  const F normal = between_rows(&table.normal[0][0], low, high, v);
  const F rest = grazing * between_rows(&table.grazing[0][0], low, high, v);
  const F3 head_on = specular * normal;
  return {head_on.x + rest, head_on.y + rest, head_on.z + rest};
}

HWY_INLINE Coloured varying_albedo(const LobeLanes<Coloured>& lobes, I at, F u) {
  const F y = lobes.roughness * set(static_cast<float>(SpecularTable::kRoughnesses - 1));
  const I row = hn::Min(truncated(y), set(SpecularTable::kRoughnesses - 2));
  const F v = y - to_float(row);
  const F3 low = specular_albedo_at(lobes.specular.v, lobes.grazing, row, at, v);
  const F3 high = specular_albedo_at(lobes.specular.v, lobes.grazing, row, at + set(1), v);
  return {mix(low, high, u)};
}

// `cosine` from 0 to 1.
template <class Reflectance>
HWY_INLINE Reflectance specular_albedo(const LobeLanes<Reflectance>& lobes, F cosine) {
  const F x = cosine * (set(2.0F) - cosine) * set(static_cast<float>(SpecularTable::kCosines - 1));
  const I at = hn::Min(truncated(x), set(SpecularTable::kCosines - 2));
  const F u = x - to_float(at);
  if constexpr (std::is_same_v<Reflectance, Coloured>) {
    if (lobes.constant == nullptr) return varying_albedo(lobes, at, u);
  }
  Reflectance* const kind = nullptr;
  return albedo(*lobes.constant, at, u, kind);
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::shading
HWY_AFTER_NAMESPACE();

#endif
