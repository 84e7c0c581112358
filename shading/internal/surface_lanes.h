// shading/surface.h over lanes. Compiled once per instruction set.
#if defined(DELRAY_SHADING_SURFACE_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef DELRAY_SHADING_SURFACE_LANES
#undef DELRAY_SHADING_SURFACE_LANES
#else
#define DELRAY_SHADING_SURFACE_LANES
#endif

#include "shading/batch_shader.h"
#include "shading/internal/brdf_lanes.h"
#include "shading/internal/texture_lanes.h"
#include "shading/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace delray::shading {
namespace HWY_NAMESPACE {

struct SurfaceLanes {
  F3 geometric_normal, normal;
  M front;
  F3 base_colour;
  F alpha, metallic, roughness;
  F3 emission;
};

HWY_INLINE F level_of(const Texture& texture, const Points& points, int i) {
  return mip_level(texture, {load(points.footprint_dx_u, i), load(points.footprint_dx_v, i),
                             load(points.footprint_dy_u, i), load(points.footprint_dy_v, i)});
}
HWY_INLINE TexelLanes looked_up(const Texture& texture, const Points& points, int i, M active) {
  return sample(texture, load(points.u, i), load(points.v, i), level_of(texture, points, i),
                active);
}

HWY_INLINE F3 normal_mapped(const Texture& texture, const scenes::Material& material,
                            const Points& points, int i, M active) {
  const F3 normal = load(points.normal, i), tangent = load(points.tangent, i);
  const F handedness = load(points.handedness, i);
  const F3 bitangent = cross(normal, tangent) * handedness;
  const TexelLanes texel = looked_up(texture, points, i, active);
  const F one = set(1.0F), two = set(2.0F), scale = set(material.normal_scale);
  const F x = (two * texel.colour.x - one) * scale;
  const F y = (two * texel.colour.y - one) * scale;
  const F z = two * texel.colour.z - one;
  const F3 mapped = tangent * x + bitangent * y + normal * z;
  const F squared = dot(mapped, mapped);
  const M usable = hn::And(hn::Gt(squared, set(0.0F)), hn::Ne(handedness, set(0.0F)));
  return choose(usable, mapped * (one / hn::Sqrt(squared)), normal);
}

HWY_INLINE F resolve_alpha(const scenes::Material& material, F alpha) {
  switch (material.alpha) {
    case scenes::Material::Alpha::opaque:
      break;
    case scenes::Material::Alpha::mask:
      return hn::IfThenElseZero(hn::Ge(alpha, set(material.alpha_cutoff)), set(1.0F));
    case scenes::Material::Alpha::blend:
      return clamp01(alpha);
  }
  return set(1.0F);
}

HWY_INLINE SurfaceLanes evaluate(const BatchShader& shader, const scenes::Material& material,
                                 const Points& points, const F3& view, int i, M active) {
  const std::vector<Texture>& textures = shader.shader->textures;
  const F zero = set(0.0F);
  const F3 geometric_normal = load(points.geometric_normal, i);
  SurfaceLanes surface;
  surface.front = hn::Ge(dot(geometric_normal, view), zero);
  const F3 normal =
      material.normal_texture == scenes::kNone
          ? load(points.normal, i)
          : normal_mapped(textures[material.normal_texture], material, points, i, active);
  surface.geometric_normal = choose(surface.front, geometric_normal, negated(geometric_normal));
  const M agree = hn::Ge(dot(normal, geometric_normal), zero);
  surface.normal = choose(hn::Xor(agree, surface.front), negated(normal), normal);

  surface.base_colour = set(glm::vec3(material.base_colour));
  F alpha = set(material.base_colour.w);
  if (points.coloured) {
    surface.base_colour = surface.base_colour * load(points.colour, i);
    alpha = alpha * load(points.colour_alpha, i);
  }
  if (material.base_colour_texture != scenes::kNone) {
    const TexelLanes texel = looked_up(textures[material.base_colour_texture], points, i, active);
    surface.base_colour = surface.base_colour * texel.colour;
    alpha = alpha * texel.alpha;
  }
  surface.alpha = resolve_alpha(material, alpha);

  surface.metallic = set(material.metallic);
  surface.roughness = set(material.roughness);
  if (material.metallic_roughness_texture != scenes::kNone) {
    const TexelLanes texel =
        looked_up(textures[material.metallic_roughness_texture], points, i, active);
    surface.roughness = surface.roughness * texel.colour.y;
    surface.metallic = surface.metallic * texel.colour.z;
  }
  surface.emission = set(material.emission);
  if (material.emission_texture != scenes::kNone) {
    surface.emission =
        surface.emission * looked_up(textures[material.emission_texture], points, i, active).colour;
  }
  return surface;
}

HWY_INLINE F3 diffuse_of(const scenes::Material& material, const SurfaceLanes& surface) {
  const F one = set(1.0F);
  const F opaque = set(1.0F - shading::clamp01(material.transmission));
  return surface.base_colour * ((one - clamp01(surface.metallic)) * opaque);
}

// Lobes::entering, not divided by pi.
HWY_INLINE F entering_of(F specular, F grazing) {
  const F mean = specular + (grazing - specular) * set(1.0F / 21.0F);
  return set(1.0F) / max_of(set(1.0F) - mean, set(1e-3F));
}

// Lobes of surfaces that differ from lane to lane.
struct VaryingLobes {
  F3 diffuse, entering, specular;
  F grazing, alpha, roughness;
};

HWY_INLINE VaryingLobes varying_lobes(const scenes::Material& material,
                                      const SurfaceLanes& surface) {
  const float ratio = (material.ior - 1.0F) / (material.ior + 1.0F);
  const F dielectric = set(ratio * ratio);
  const F metallic = clamp01(surface.metallic);
  const F3 specular{mix(dielectric, surface.base_colour.x, metallic),
                    mix(dielectric, surface.base_colour.y, metallic),
                    mix(dielectric, surface.base_colour.z, metallic)};
  const F brightest = max_of(max_of(specular.x, specular.y), specular.z);
  const F grazing = min_of(set(50.0F) * brightest, set(1.0F));
  const F3 entering{entering_of(specular.x, grazing), entering_of(specular.y, grazing),
                    entering_of(specular.z, grazing)};
  const F roughness = clamp01(surface.roughness);
  const F wide = max_of(roughness, set(kMinRoughness));
  return {diffuse_of(material, surface), entering, specular, grazing, wide * wide, roughness};
}

HWY_INLINE VaryingLobes constant_lobes(const BatchMaterial& material, const SurfaceLanes& surface) {
  const Lobes& l = material.lobes;
  return {diffuse_of(material.material, surface),
          set(l.entering),
          set(l.specular),
          set(l.grazing),
          set(l.alpha),
          set(l.roughness)};
}

HWY_INLINE LobeLanes<Coloured> ready(const VaryingLobes& l) {
  const F3 rise{l.grazing - l.specular.x, l.grazing - l.specular.y, l.grazing - l.specular.z};
  return {l.diffuse,         {l.entering * set(kInversePi)},
          {l.specular},      {rise},
          l.grazing,         l.roughness,
          l.alpha * l.alpha, nullptr};
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::shading
HWY_AFTER_NAMESPACE();

#endif
