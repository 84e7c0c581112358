#include <cassert>

#include "shading/batch.h"

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
  const BatchMaterial& constants = shader.material(number);
  const scenes::Material& material = constants.material;
  const bool varying =
      (points.coloured ? constants.coloured : constants.plain) == BatchMaterial::Specular::varying;
  for (int i = 0; i < kBlockPoints; i += lanes()) {
    const M active = mask_of(mask, i);
    if (hn::AllFalse(FloatTag(), active)) continue;
    const F3 view = load(views, i);
    const SurfaceLanes s = evaluate(shader, material, points, view, i, active);
    store(load(points.position, i), active, i, out.position);
    store(s.geometric_normal, active, i, out.geometric_normal);
    store(s.normal, active, i, out.normal);
    const IntTag di;
    hn::Store(
        hn::IfThenElse(hn::RebindMask(di, active), hn::VecFromMask(di, hn::RebindMask(di, s.front)),
                       hn::Load(di, out.front + i)),
        di, out.front + i);
    store(s.base_colour, active, i, out.base_colour);
    store(s.alpha, active, i, out.alpha);
    store(s.metallic, active, i, out.metallic);
    store(s.roughness, active, i, out.roughness);
    store(set(material.transmission), active, i, out.transmission);
    store(set(material.ior), active, i, out.ior);
    store(s.emission, active, i, out.emission);
    const VaryingLobes l = varying ? varying_lobes(material, s) : constant_lobes(constants, s);
    store(l.diffuse, active, i, out.diffuse);
    store(l.entering, active, i, out.entering);
    store(l.specular, active, i, out.specular);
    store(l.grazing, active, i, out.grazing);
    store(l.alpha, active, i, out.lobe_alpha);
    store(l.roughness, active, i, out.lobe_roughness);
    LobeLanes<Coloured> lobes = ready(l);
    if (!varying) lobes.constant = &constants;
    store(specular_albedo(lobes, clamp01(dot(s.normal, view))).v, active, i, out.mirrored);
  }
}

HWY_INLINE LobeLanes<Coloured> loaded_lobes(const Surfaces& s, int i) {
  return ready(VaryingLobes{load(s.diffuse, i), load(s.entering, i), load(s.specular, i),
                            load(s.grazing, i), load(s.lobe_alpha, i), load(s.lobe_roughness, i)});
}

// Each term of the light from everywhere, for one vector.
struct Diffuse {
  static HWY_INLINE F3 of(const BatchShader& shader, const Surfaces& s, const F3&, M, int i) {
    return ambient_diffuse(shader.shader->environment, load(s.diffuse, i),
                           Coloured{load(s.mirrored, i)}, load(s.normal, i));
  }
};
struct Specular {
  static HWY_INLINE F3 of(const BatchShader& shader, const Surfaces& s, const F3& view, M active,
                          int i) {
    const F3 normal = load(s.normal, i);
    return ambient_specular(*shader.shader, load(s.lobe_roughness, i),
                            Coloured{load(s.mirrored, i)}, normal, view, dot(normal, view), active);
  }
};
struct Transmitted {
  static HWY_INLINE F3 of(const BatchShader& shader, const Surfaces& s, const F3& view, M active,
                          int i) {
    const F share = clamp01(load(s.transmission, i)) * (set(1.0F) - clamp01(load(s.metallic, i)));
    const M some = hn::And(active, hn::Gt(share, set(0.0F)));
    if (hn::AllFalse(FloatTag(), some)) return set(glm::vec3(0.0F));
    return ambient_transmitted(*shader.shader, load(s.lobe_roughness, i),
                               Coloured{load(s.mirrored, i)}, load(s.base_colour, i), share, view,
                               some);
  }
};

template <class Term>
HWY_INLINE void ambient(const BatchShader& shader, const Surfaces& surfaces, const Vectors16& views,
                        LaneMask mask, Vectors16& colours) {
  for (int i = 0; i < kBlockPoints; i += lanes()) {
    const M active = mask_of(mask, i);
    if (hn::AllFalse(FloatTag(), active)) continue;
    const F3 colour = shader.shader->environment.black
                          ? set(glm::vec3(0.0F))
                          : Term::of(shader, surfaces, load(views, i), active, i);
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

void coverage_block(const BatchShader& shader, std::uint32_t number, const Points& points,
                    LaneMask mask, Floats16& alphas) {
  const scenes::Material& material = shader.material(number).material;
  for (int i = 0; i < kBlockPoints; i += lanes()) {
    const M active = mask_of(mask, i);
    if (hn::AllFalse(FloatTag(), active)) continue;
    F alpha = set(material.base_colour.w);
    if (points.coloured) alpha = alpha * load(points.colour_alpha, i);
    const bool textured = material.alpha != scenes::Material::Alpha::opaque &&
                          material.base_colour_texture != scenes::kNone;
    if (textured) {
      const Texture& texture = shader.shader->textures[material.base_colour_texture];
      alpha = alpha * sample_alpha(texture, load(points.u, i), load(points.v, i),
                                   level_of(texture, points, i), active);
    }
    store(resolve_alpha(material, alpha), active, i, alphas);
  }
}

void sample_block(const Texture& texture, const Points& points, LaneMask mask, Shaded& texels) {
  for (int i = 0; i < kBlockPoints; i += lanes()) {
    const M active = mask_of(mask, i);
    if (hn::AllFalse(FloatTag(), active)) continue;
    const TexelLanes texel = looked_up(texture, points, i, active);
    store(texel.colour, active, i, texels.colour);
    store(texel.alpha, active, i, texels.alpha);
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
HWY_EXPORT(coverage_block);
HWY_EXPORT(sample_block);

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

void coverage(const BatchShader& shader, std::uint32_t material, const Points& points,
              LaneMask lanes, Floats16& alpha) {
  HWY_DYNAMIC_DISPATCH(coverage_block)(shader, material, points, lanes, alpha);
}

void sample(const Texture& texture, const Points& points, LaneMask lanes, Shaded& texels) {
  HWY_DYNAMIC_DISPATCH(sample_block)(texture, points, lanes, texels);
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
