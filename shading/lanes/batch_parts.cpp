// The functions of shading/batch.h for renderers that need the terms of shading one by one:
// surfaces, light from the environment, the contribution of one light, coverage, texels.
//
// Each term is computed for a block of 16 points in vectors of lanes, compiled once for each
// instruction set that Highway targets. Coats and sheens are added point by point, by the scalar
// functions of shading/layers.h.
#include <bit>
#include <cassert>

#include "shading/batch.h"
#include "shading/shade.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/lanes/batch_parts.cpp"
#include <hwy/foreach_target.h>
// What is compiled per target comes after it.
#include <hwy/highway.h>

#include "shading/lanes/shade_lanes.h"
#include "shading/lanes/surface_lanes.h"

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
    store(s.transmission, active, i, out.transmission);
    store(set(material.ior), active, i, out.ior);
    store(s.emission, active, i, out.emission);
    if (material.transmission > 0.0F) {
      store(tint_of(constants, s.base_colour, s.front), active, i, out.tint);
    }
    const F cosine = clamp01(dot(s.normal, view));
    const LobesLanes l = varying ? varying_lobes(shader, constants, s, points, i, active)
                                 : constant_lobes(constants.lobes, diffuse_of(s));
    const ResponseLanes<Coloured> seen = response(
        l, varying ? varying_shares(l.roughness, cosine) : constant_shares(constants, cosine));
    store(l.diffuse, active, i, out.diffuse);
    store(l.specular, active, i, out.specular);
    store(l.grazing, active, i, out.grazing);
    store(l.alpha, active, i, out.lobe_alpha);
    store(l.roughness, active, i, out.lobe_roughness);
    store(seen.specular.v, active, i, out.mirrored);
    store(seen.scale.v, active, i, out.scale);
    store(seen.entering, active, i, out.entering);
  }
}

HWY_INLINE LobeLanes<Coloured> loaded_lobes(const Surfaces& s, F facing, int i) {
  const F3 specular = load(s.specular, i);
  const F grazing = load(s.grazing, i);
  return seen_lobes<Coloured>(load(s.diffuse, i), load(s.entering, i), {specular},
                              {{grazing - specular.x, grazing - specular.y, grazing - specular.z}},
                              {load(s.scale, i)}, load(s.lobe_alpha, i), facing);
}

// Each term of the light from everywhere, for one vector.
struct Diffuse {
  static HWY_INLINE F3 of(const BatchShader& shader, const Surfaces& s, const F3&, M, int i) {
    return load(s.diffuse, i) * load(s.entering, i) *
           diffuse_radiance(shader.shader->environment, load(s.normal, i));
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
    const F share = transmitted_share(load(s.transmission, i), load(s.metallic, i));
    const M some = hn::And(active, hn::Gt(share, set(0.0F)));
    if (hn::AllFalse(FloatTag(), some)) return set(glm::vec3(0.0F));
    return ambient_transmitted(*shader.shader, load(s.lobe_roughness, i), load(s.entering, i),
                               load(s.tint, i), share, view, some);
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
  for (int i = 0; i < kBlockPoints; i += lanes()) {
    const M active = mask_of(mask, i);
    if (hn::AllFalse(FloatTag(), active)) continue;
    const F3 normal = load(surfaces.normal, i), view = load(views, i);
    const LobeLanes<Coloured> lobes = loaded_lobes(surfaces, dot(normal, view), i);
    const ReflectedLanes one = reflected(light, lobes, load(surfaces.position, i), normal, view);
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
    const LobeLanes<Coloured> lobes = loaded_lobes(surfaces, dot(normal, view), i);
    store(reflect(lobes, normal, view, load(directions, i)), active, i, reflected);
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
      const TexturePoints& at = points.uvs[texture.set];
      alpha = alpha *
              sample_alpha(texture, load(at.u, i), load(at.v, i), level_of(texture, at, i), active);
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

namespace {

Point point_at(const Points& points, int i) {
  Point point;
  point.geometric_normal = points.geometric_normal.get(i);
  point.normal = points.normal.get(i);
  const TexturePoint first = points.uvs[0].get(i);
  point.uv = first.uv;
  point.footprint = first.footprint;
  point.second = points.uvs[1].get(i);
  return point;
}

void multiply(Vectors16& v, int i, float factor) { v.set(i, v.get(i) * factor); }

void add_layers(const BatchShader& shader, const scenes::Material& material, const Points& points,
                const Vectors16& views, int i, Surfaces& s) {
  Surface surface;
  surface.front = s.front[i] != 0;
  surface.normal = s.normal.get(i);
  evaluate_layers(*shader.shader, material, point_at(points, i), surface);
  const Layers& layers = s.layers[i] = shading::layers(surface, views.get(i));
  multiply(s.emission, i, layers.below_coat);
  multiply(s.mirrored, i, layers.below);
  multiply(s.scale, i, layers.below);
  s.entering[i] *= layers.below;
}

glm::vec3 reflect_layered(const Surfaces& s, int i, const glm::vec3& view, const glm::vec3& light) {
  const Response response{glm::vec3(0.0F), s.scale.get(i), s.entering[i]};
  const glm::vec3 normal = s.normal.get(i);
  return reflect(lobes_at(s, i), response, normal, view, light) +
         reflect(s.layers[i], normal, view, light);
}

}  // namespace

void evaluate(const BatchShader& shader, std::uint32_t number, const Points& points,
              const Vectors16& views, LaneMask lanes, Surfaces& surfaces) {
  HWY_DYNAMIC_DISPATCH(evaluate_block)(shader, number, points, views, lanes, surfaces);
  const BatchMaterial& constants = shader.material(number);
  const scenes::Material& material = constants.material;
  surfaces.thin &= ~lanes;
  surfaces.layered &= ~lanes;
  if (constants.layered) {
    surfaces.layered |= lanes;
    for (LaneMask rest = lanes; rest != 0; rest &= rest - 1) {
      add_layers(shader, material, points, views, std::countr_zero(rest), surfaces);
    }
  }
  if (material.transmission > 0.0F && !(material.thickness > 0.0F)) {
    surfaces.thin |= lanes;
    for (LaneMask rest = lanes; rest != 0; rest &= rest - 1) {
      surfaces.front[std::countr_zero(rest)] = -1;
    }
  }
}

void ambient_diffuse(const BatchShader& shader, const Surfaces& surfaces, const Vectors16& views,
                     LaneMask lanes, Vectors16& colours) {
  HWY_DYNAMIC_DISPATCH(ambient_diffuse_block)(shader, surfaces, views, lanes, colours);
  const Environment& environment = shader.shader->environment;
  if (environment.black) return;
  for (LaneMask rest = lanes & surfaces.layered; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    colours.set(i,
                (surfaces.diffuse.get(i) * surfaces.entering[i] + surfaces.layers[i].sheen_albedo) *
                    diffuse_radiance(environment, surfaces.normal.get(i)));
  }
}

void ambient_specular(const BatchShader& shader, const Surfaces& surfaces, const Vectors16& views,
                      LaneMask lanes, Vectors16& colours) {
  HWY_DYNAMIC_DISPATCH(ambient_specular_block)(shader, surfaces, views, lanes, colours);
}

void ambient_coat(const BatchShader& shader, const Surfaces& surfaces, const Vectors16& views,
                  LaneMask lanes, Vectors16& colours) {
  for (; lanes != 0; lanes &= lanes - 1) {
    const int i = std::countr_zero(lanes);
    if ((surfaces.layered >> i & 1) == 0) {
      colours.set(i, glm::vec3(0.0F));
      continue;
    }
    colours.set(i, ambient_coat(*shader.shader, {views.get(i), {}, surfaces.layers[i], {}}));
  }
}

void ambient_transmitted(const BatchShader& shader, const Surfaces& surfaces,
                         const Vectors16& views, LaneMask lanes, Vectors16& colours) {
  HWY_DYNAMIC_DISPATCH(ambient_transmitted_block)(shader, surfaces, views, lanes, colours);
}

LaneMask reflect_light(const BatchShader& shader, std::size_t light, const Surfaces& surfaces,
                       const Vectors16& views, LaneMask lanes, Arriving& arriving) {
  assert(light < shader.lights.size());
  if (shader.lights[light].dark) return 0;
  const LaneMask layered = lanes & surfaces.layered;
  LaneMask reached = 0;
  if (lanes != layered) {
    reached = HWY_DYNAMIC_DISPATCH(reflect_light_block)(shader, light, surfaces, views,
                                                        lanes & ~layered, arriving);
  }
  for (LaneMask rest = layered; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const Incident from = incident(shader.shader->lights[light], surfaces.position.get(i));
    const glm::vec3 reflected =
        reflect_layered(surfaces, i, views.get(i), from.direction) * from.irradiance;
    if (!(reflected.x > 0.0F || reflected.y > 0.0F || reflected.z > 0.0F)) continue;
    arriving.direction.set(i, from.direction);
    arriving.distance[i] = from.distance;
    arriving.reflected.set(i, reflected);
    reached |= 1U << i;
  }
  return reached;
}

void reflect(const Surfaces& surfaces, const Vectors16& views, const Vectors16& directions,
             LaneMask lanes, Vectors16& reflected) {
  HWY_DYNAMIC_DISPATCH(reflect_block)(surfaces, views, directions, lanes, reflected);
  for (LaneMask rest = lanes & surfaces.layered; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    reflected.set(i, reflect_layered(surfaces, i, views.get(i), directions.get(i)));
  }
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

void remove_diffuse(Surfaces& s, int i) {
  s.diffuse.set(i, glm::vec3(0.0F));
  if ((s.layered >> i & 1) == 0) return;
  s.layers[i].sheen = s.layers[i].sheen_albedo = glm::vec3(0.0F);
}

void keep_diffuse(Surfaces& s, int i) {
  s.specular.set(i, glm::vec3(0.0F));
  s.mirrored.set(i, glm::vec3(0.0F));
  s.grazing[i] = s.transmission[i] = 0.0F;
  if ((s.layered >> i & 1) == 0) return;
  s.layers[i].coat = s.layers[i].coat_albedo = 0.0F;
}

Surface surface_at(const Surfaces& s, int i) {
  Surface surface;
  surface.position = s.position.get(i);
  surface.geometric_normal = s.geometric_normal.get(i);
  surface.normal = s.normal.get(i);
  surface.front = s.front[i] != 0;
  surface.base_colour = s.base_colour.get(i);
  surface.alpha = s.alpha[i];
  surface.metallic = s.metallic[i];
  surface.roughness = s.roughness[i];
  surface.transmission = s.transmission[i];
  surface.ior = s.ior[i];
  surface.emission = s.emission.get(i);
  return surface;
}

Lobes lobes_at(const Surfaces& s, int i) {
  Lobes lobes;
  lobes.diffuse = s.diffuse.get(i);
  lobes.specular = s.specular.get(i);
  lobes.grazing = s.grazing[i];
  lobes.alpha = s.lobe_alpha[i];
  lobes.roughness = s.lobe_roughness[i];
  return lobes;
}

}  // namespace delray::shading
#endif
