// shading/surface.h over lanes. Compiled once per instruction set.
#if defined(DELRAY_SHADING_SURFACE_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef DELRAY_SHADING_SURFACE_LANES
#undef DELRAY_SHADING_SURFACE_LANES
#else
#define DELRAY_SHADING_SURFACE_LANES
#endif

#include "shading/batch_shader.h"
#include "shading/lanes.h"
#include "shading/lanes/brdf_lanes.h"
#include "shading/lanes/texture_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace delray::shading {
namespace HWY_NAMESPACE {

struct SurfaceLanes {
  F3 geometric_normal, normal;
  M front;
  F3 base_colour;
  F alpha, metallic, roughness, transmission;
  F3 emission;
};

HWY_INLINE F level_of(const Texture& texture, const TexturePoints& at, int i) {
  return mip_level(texture,
                   {load(at.dx_u, i), load(at.dx_v, i), load(at.dy_u, i), load(at.dy_v, i)});
}
HWY_INLINE TexelLanes looked_up(const Texture& texture, const Points& points, int i, M active) {
  const TexturePoints& at = points.uvs[texture.set];
  return sample(texture, load(at.u, i), load(at.v, i), level_of(texture, at, i), active);
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
  surface.transmission = set(material.transmission);
  if (material.transmission_texture != scenes::kNone) {
    const TexelLanes texel = looked_up(textures[material.transmission_texture], points, i, active);
    surface.transmission = surface.transmission * texel.colour.x;
  }
  surface.emission = set(material.emission);
  if (material.unlit) {
    surface.emission = surface.base_colour;
    surface.base_colour = set(glm::vec3(0.0F));
  }
  if (material.emission_texture != scenes::kNone) {
    surface.emission =
        surface.emission * looked_up(textures[material.emission_texture], points, i, active).colour;
  }
  return surface;
}

HWY_INLINE F3 diffuse_of(const SurfaceLanes& surface) {
  const F one = set(1.0F);
  return surface.base_colour *
         ((one - clamp01(surface.metallic)) * (one - clamp01(surface.transmission)));
}

HWY_INLINE F grazing_of(const F3& reflectance) {
  return min_of(set(50.0F) * max_of(max_of(reflectance.x, reflectance.y), reflectance.z),
                set(1.0F));
}

// Where textures say how strongly the dielectric reflects. Sets dielectric and dielectric_grazing.
inline HWY_NOINLINE void look_up_specular(const BatchShader& shader,
                                          const scenes::Material& material, const Points& points,
                                          int i, M active, LobesLanes& lobes) {
  const std::vector<Texture>& textures = shader.shader->textures;
  const F one = set(1.0F);
  F strength = set(material.specular);
  F3 colour = set(material.specular_colour);
  if (material.specular_texture != scenes::kNone) {
    strength = strength * looked_up(textures[material.specular_texture], points, i, active).alpha;
  }
  if (material.specular_colour_texture != scenes::kNone) {
    colour =
        colour * looked_up(textures[material.specular_colour_texture], points, i, active).colour;
  }
  const float ratio = (material.ior - 1.0F) / (material.ior + 1.0F);
  const F3 head_on = colour * set(ratio * ratio);
  lobes.dielectric =
      F3{min_of(head_on.x, one), min_of(head_on.y, one), min_of(head_on.z, one)} * strength;
  lobes.dielectric_grazing = grazing_of(lobes.dielectric) * strength;
}

// Of surfaces that differ from lane to lane.
HWY_INLINE LobesLanes varying_lobes(const BatchShader& shader, const BatchMaterial& constants,
                                    const SurfaceLanes& surface, const Points& points, int i,
                                    M active) {
  const scenes::Material& material = constants.material;
  LobesLanes l = constant_lobes(constants.lobes, diffuse_of(surface));
  if (has_specular_texture(material)) {
    look_up_specular(shader, material, points, i, active, l);
  }
  l.metallic = clamp01(surface.metallic);
  l.metal = surface.base_colour;
  l.metal_grazing = grazing_of(l.metal);
  l.specular = mix(l.dielectric, l.metal, l.metallic);
  l.grazing = mix(l.dielectric_grazing, l.metal_grazing, l.metallic);
  l.roughness = clamp01(surface.roughness);
  const F mean = mean_albedo(l.roughness);
  l.dielectric_again = again(l.dielectric, l.dielectric_grazing, mean);
  l.metal_again = again(l.metal, l.metal_grazing, mean);
  const F wide = max_of(l.roughness, set(kMinRoughness));
  l.alpha = wide * wide;
  return l;
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::shading
HWY_AFTER_NAMESPACE();

#endif
