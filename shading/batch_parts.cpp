#include <cassert>

#include "shading/batch.h"

#include "shading/internal/targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/batch_parts.cpp"
#include <hwy/foreach_target.h>
// What is compiled per target comes after it.
#include <hwy/highway.h>

#include "shading/internal/shade_lanes.h"
#include "shading/internal/surface_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace delray::shading {
namespace HWY_NAMESPACE {

void evaluate_block(const BatchShader& shader, std::uint32_t number, const Points& points,
                    const Vectors16& views, LaneMask mask, Surfaces& out) {
  const scenes::Material& material = shader.material(number).material;
  for (int i = 0; i < kBlockPoints; i += lanes()) {
    const M active = mask_of(mask, i);
    if (hn::AllFalse(FloatTag(), active)) continue;
    const SurfaceLanes s = evaluate(shader, material, points, load(views, i), i, active);
    store(load(points.position, i), active, i, out.position);
    store(s.geometric_normal, active, i, out.geometric_normal);
    store(s.normal, active, i, out.normal);
    const IntTag di;
    hn::BlendedStore(hn::VecFromMask(di, hn::RebindMask(di, s.front)), hn::RebindMask(di, active),
                     di, out.front + i);
    store(s.base_colour, active, i, out.base_colour);
    store(s.alpha, active, i, out.alpha);
    store(s.metallic, active, i, out.metallic);
    store(s.roughness, active, i, out.roughness);
    store(set(material.transmission), active, i, out.transmission);
    store(set(material.ior), active, i, out.ior);
    store(s.emission, active, i, out.emission);
    const VaryingLobes l = varying_lobes(material, s);
    store(l.diffuse, active, i, out.diffuse);
    store(l.entering, active, i, out.entering);
    store(l.specular, active, i, out.specular);
    store(l.grazing, active, i, out.grazing);
    store(l.alpha, active, i, out.lobe_alpha);
    store(l.roughness, active, i, out.lobe_roughness);
  }
}

HWY_INLINE LobeLanes<Coloured> loaded_lobes(const Surfaces& s, int i) {
  return ready(VaryingLobes{load(s.diffuse, i), load(s.entering, i), load(s.specular, i),
                            load(s.grazing, i), load(s.lobe_alpha, i), load(s.lobe_roughness, i)});
}

// Each term of the light from everywhere, for one vector.
struct Diffuse {
  static HWY_INLINE F3 of(const BatchShader& shader, const Surfaces& s, const F3&, F cosine, M,
                          int i) {
    const LobeLanes<Coloured> lobes = loaded_lobes(s, i);
    return ambient_diffuse(shader.shader->environment, lobes,
                           specular_albedo(lobes, clamp01(cosine)), load(s.normal, i));
  }
};
struct Specular {
  static HWY_INLINE F3 of(const BatchShader& shader, const Surfaces& s, const F3& view, F cosine,
                          M active, int i) {
    const LobeLanes<Coloured> lobes = loaded_lobes(s, i);
    return ambient_specular(*shader.shader, lobes, specular_albedo(lobes, clamp01(cosine)),
                            load(s.normal, i), view, cosine, active);
  }
};
struct Transmitted {
  static HWY_INLINE F3 of(const BatchShader& shader, const Surfaces& s, const F3& view, F cosine,
                          M active, int i) {
    const F share = clamp01(load(s.transmission, i)) * (set(1.0F) - clamp01(load(s.metallic, i)));
    const M some = hn::And(active, hn::Gt(share, set(0.0F)));
    if (hn::AllFalse(FloatTag(), some)) return set(glm::vec3(0.0F));
    const LobeLanes<Coloured> lobes = loaded_lobes(s, i);
    return ambient_transmitted(*shader.shader, lobes, specular_albedo(lobes, clamp01(cosine)),
                               load(s.base_colour, i), share, view, some);
  }
};

template <class Term>
HWY_INLINE void ambient(const BatchShader& shader, const Surfaces& surfaces, const Vectors16& views,
                        LaneMask mask, Vectors16& colours) {
  for (int i = 0; i < kBlockPoints; i += lanes()) {
    const M active = mask_of(mask, i);
    if (hn::AllFalse(FloatTag(), active)) continue;
    F3 colour = set(glm::vec3(0.0F));
    if (!shader.shader->environment.black) {
      const F3 view = load(views, i);
      const F cosine = dot(load(surfaces.normal, i), view);
      colour = Term::of(shader, surfaces, view, cosine, active, i);
    }
    store(colour, active, i, colours);
  }
}

void ambient_diffuse_block(const BatchShader& shader, const Surfaces& surfaces,
                           const Vectors16& views, LaneMask mask, Vectors16& colours) {
  ambient<Diffuse>(shader, surfaces, views, mask, colours);
}
void ambient_specular_block(const BatchShader& shader, const Surfaces& surfaces,
                            const Vectors16& views, LaneMask mask, Vectors16& colours) {
  ambient<Specular>(shader, surfaces, views, mask, colours);
}
void ambient_transmitted_block(const BatchShader& shader, const Surfaces& surfaces,
                               const Vectors16& views, LaneMask mask, Vectors16& colours) {
  ambient<Transmitted>(shader, surfaces, views, mask, colours);
}

LaneMask reflect_light_block(const BatchShader& shader, std::size_t number,
                             const Surfaces& surfaces, const Vectors16& views, LaneMask mask,
                             Arriving& arriving) {
  const BatchLight& light = shader.lights[number];
  LaneMask result = 0;
  if (light.dark) return result;
  for (int i = 0; i < kBlockPoints; i += lanes()) {
    const M active = mask_of(mask, i);
    if (hn::AllFalse(FloatTag(), active)) continue;
    const F3 normal = load(surfaces.normal, i), view = load(views, i);
    const LobeLanes<Coloured> lobes = loaded_lobes(surfaces, i);
    const ReflectedLanes one = reflected(light, lobes, view_terms(lobes, dot(normal, view)),
                                         load(surfaces.position, i), normal, view);
    const M matters = hn::And(active, one.matters);
    store(one.light.direction, matters, i, arriving.direction);
    store(one.light.distance, matters, i, arriving.distance);
    store(one.reflected, matters, i, arriving.reflected);
    result |= bits_of(matters, i);
  }
  return result;
}

void reflect_block(const Surfaces& surfaces, const Vectors16& views, const Vectors16& directions,
                   LaneMask mask, Vectors16& reflected) {
  for (int i = 0; i < kBlockPoints; i += lanes()) {
    const M active = mask_of(mask, i);
    if (hn::AllFalse(FloatTag(), active)) continue;
    const F3 normal = load(surfaces.normal, i), view = load(views, i);
    const LobeLanes<Coloured> lobes = loaded_lobes(surfaces, i);
    store(reflect(lobes, view_terms(lobes, dot(normal, view)), normal, view, load(directions, i)),
          active, i, reflected);
  }
}

void environment_radiance_block(const BatchShader& shader, const Vectors16& directions,
                                float roughness, LaneMask mask, Vectors16& colours) {
  const Shader& scene = *shader.shader;
  for (int i = 0; i < kBlockPoints; i += lanes()) {
    const M active = mask_of(mask, i);
    if (hn::AllFalse(FloatTag(), active)) continue;
    const F3 colour = scene.environment.black
                          ? set(glm::vec3(0.0F))
                          : radiance(scene.environment, scene.textures, load(directions, i),
                                     set(roughness), active);
    store(colour, active, i, colours);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::shading
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::shading {

HWY_EXPORT(evaluate_block);
HWY_EXPORT(ambient_diffuse_block);
HWY_EXPORT(ambient_specular_block);
HWY_EXPORT(ambient_transmitted_block);
HWY_EXPORT(reflect_light_block);
HWY_EXPORT(reflect_block);
HWY_EXPORT(environment_radiance_block);

void evaluate(const BatchShader& shader, std::uint32_t material, const Points& points,
              const Vectors16& views, LaneMask lanes, Surfaces& surfaces) {
  HWY_DYNAMIC_DISPATCH(evaluate_block)(shader, material, points, views, lanes, surfaces);
}

void ambient_diffuse(const BatchShader& shader, const Surfaces& surfaces, const Vectors16& views,
                     LaneMask lanes, Vectors16& colours) {
  HWY_DYNAMIC_DISPATCH(ambient_diffuse_block)(shader, surfaces, views, lanes, colours);
}

void ambient_specular(const BatchShader& shader, const Surfaces& surfaces, const Vectors16& views,
                      LaneMask lanes, Vectors16& colours) {
  HWY_DYNAMIC_DISPATCH(ambient_specular_block)(shader, surfaces, views, lanes, colours);
}

void ambient_transmitted(const BatchShader& shader, const Surfaces& surfaces,
                         const Vectors16& views, LaneMask lanes, Vectors16& colours) {
  HWY_DYNAMIC_DISPATCH(ambient_transmitted_block)(shader, surfaces, views, lanes, colours);
}

LaneMask reflect_light(const BatchShader& shader, std::size_t light, const Surfaces& surfaces,
                       const Vectors16& views, LaneMask lanes, Arriving& arriving) {
  assert(light < shader.lights.size());
  return HWY_DYNAMIC_DISPATCH(reflect_light_block)(shader, light, surfaces, views, lanes, arriving);
}

void reflect(const Surfaces& surfaces, const Vectors16& views, const Vectors16& directions,
             LaneMask lanes, Vectors16& reflected) {
  HWY_DYNAMIC_DISPATCH(reflect_block)(surfaces, views, directions, lanes, reflected);
}

void environment_radiance(const BatchShader& shader, const Vectors16& directions, float roughness,
                          LaneMask lanes, Vectors16& colours) {
  HWY_DYNAMIC_DISPATCH(environment_radiance_block)(shader, directions, roughness, lanes, colours);
}

Surface surface_at(const Surfaces& s, int lane) {
  return {s.position.get(lane),    s.geometric_normal.get(lane),
          s.normal.get(lane),      s.front[lane] != 0,
          s.base_colour.get(lane), s.alpha[lane],
          s.metallic[lane],        s.roughness[lane],
          s.transmission[lane],    s.ior[lane],
          s.emission.get(lane)};
}

Lobes lobes_at(const Surfaces& s, int lane) {
  return {s.diffuse.get(lane), s.entering.get(lane), s.specular.get(lane),
          s.grazing[lane],     s.lobe_alpha[lane],   s.lobe_roughness[lane]};
}

}  // namespace delray::shading
#endif
