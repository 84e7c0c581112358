#include "shading/batch.h"

#include <cassert>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/batch.cpp"
#include <hwy/foreach_target.h>
// What is compiled per target comes after it.
#include <hwy/highway.h>

#include "shading/internal/shade_lanes.h"
#include "shading/internal/surface_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace delray::shading {
namespace HWY_NAMESPACE {

void directions_to_block(const glm::vec3& eye, const glm::vec3& otherwise,
                         const Vectors16& positions, Vectors16& views) {
  for (int i = 0; i < kBlockPoints; i += lanes()) {
    const F3 way = set(eye) - load(positions, i);
    const F squared = dot(way, way);
    const F3 unit = way * (set(1.0F) / hn::Sqrt(squared));
    const F3 view = choose(hn::Gt(squared, set(0.0F)), unit, set(otherwise));
    store(view, hn::FirstN(FloatTag(), static_cast<std::size_t>(lanes())), i, views);
  }
}

template <class Reflectance>
HWY_INLINE F3 direct(const BatchShader& shader, const LobeLanes<Reflectance>& lobes,
                     const F3& position, const F3& normal, const F3& view, F cosine, int i,
                     std::span<const Vectors16> visibility) {
  const ViewTerms<Reflectance> viewer = view_terms(lobes, cosine);
  F3 sum = set(glm::vec3(0.0F));
  for (std::size_t l = 0; l < shader.lights.size(); ++l) {
    if (shader.lights[l].dark) continue;
    const ReflectedLanes one = reflected(shader.lights[l], lobes, viewer, position, normal, view);
    const F3 all = visibility.empty() ? one.reflected : one.reflected * load(visibility[l], i);
    sum = sum + where(one.matters, all);
  }
  return sum;
}

// One vector of points whose lobes are known.
template <class Reflectance>
HWY_INLINE void shade_lit(const BatchShader& shader, const scenes::Material& material,
                          const Points& points, const SurfaceLanes& surface,
                          const LobeLanes<Reflectance>& lobes, const F3& view, M active, int i,
                          std::span<const Vectors16> visibility, Shaded& shaded) {
  const Shader& scene = *shader.shader;
  const F cosine = dot(surface.normal, view);
  F3 sum = surface.emission;
  if (!scene.environment.black) {
    const Reflectance mirrored = specular_albedo(lobes, clamp01(cosine));
    sum = sum + ambient_diffuse(scene.environment, lobes.diffuse, mirrored, surface.normal);
    sum = sum +
          ambient_specular(scene, lobes.roughness, mirrored, surface.normal, view, cosine, active);
    const float transmission = shading::clamp01(material.transmission);
    if (transmission > 0.0F) {
      const F share = set(transmission) * (set(1.0F) - clamp01(surface.metallic));
      sum = sum + ambient_transmitted(scene, lobes.roughness, mirrored, surface.base_colour, share,
                                      view, active);
    }
  }
  sum = sum + direct(shader, lobes, load(points.position, i), surface.normal, view, cosine, i,
                     visibility);
  store(sum, active, i, shaded.colour);
  store(surface.alpha, active, i, shaded.alpha);
}

template <class Reflectance>
HWY_NOINLINE void shade_constant(const BatchShader& shader, const BatchMaterial& material,
                                 const Points& points, const Vectors16& views, LaneMask lane_mask,
                                 std::span<const Vectors16> visibility, Shaded& shaded) {
  for (int i = 0; i < kBlockPoints; i += lanes()) {
    const M active = mask_of(lane_mask, i);
    if (hn::AllFalse(FloatTag(), active)) continue;
    const F3 view = load(views, i);
    const SurfaceLanes surface = evaluate(shader, material.material, points, view, i, active);
    const LobeLanes<Reflectance> lobes =
        constant_lobes<Reflectance>(material, diffuse_of(material.material, surface));
    shade_lit(shader, material.material, points, surface, lobes, view, active, i, visibility,
              shaded);
  }
}

HWY_NOINLINE void shade_varying(const BatchShader& shader, const BatchMaterial& material,
                                const Points& points, const Vectors16& views, LaneMask lane_mask,
                                std::span<const Vectors16> visibility, Shaded& shaded) {
  for (int i = 0; i < kBlockPoints; i += lanes()) {
    const M active = mask_of(lane_mask, i);
    if (hn::AllFalse(FloatTag(), active)) continue;
    const F3 view = load(views, i);
    const SurfaceLanes surface = evaluate(shader, material.material, points, view, i, active);
    const LobeLanes<Coloured> lobes = ready(varying_lobes(material.material, surface));
    shade_lit(shader, material.material, points, surface, lobes, view, active, i, visibility,
              shaded);
  }
}

void shade_block(const BatchShader& shader, std::uint32_t number, const Points& points,
                 const Vectors16& views, LaneMask lane_mask, std::span<const Vectors16> visibility,
                 Shaded& shaded) {
  const BatchMaterial& material = shader.material(number);
  switch (points.coloured ? material.coloured : material.plain) {
    case BatchMaterial::Specular::grey:
      return shade_constant<Grey>(shader, material, points, views, lane_mask, visibility, shaded);
    case BatchMaterial::Specular::coloured:
      return shade_constant<Coloured>(shader, material, points, views, lane_mask, visibility,
                                      shaded);
    case BatchMaterial::Specular::varying:
      return shade_varying(shader, material, points, views, lane_mask, visibility, shaded);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::shading
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::shading {

HWY_EXPORT(directions_to_block);
HWY_EXPORT(shade_block);

void directions_to(const glm::vec3& eye, const glm::vec3& otherwise, const Vectors16& positions,
                   Vectors16& views) {
  HWY_DYNAMIC_DISPATCH(directions_to_block)(eye, otherwise, positions, views);
}

void shade(const BatchShader& shader, std::uint32_t material, const Points& points,
           const Vectors16& views, LaneMask lanes, std::span<const Vectors16> visibility,
           Shaded& shaded) {
  assert(visibility.empty() || visibility.size() == shader.lights.size());
  HWY_DYNAMIC_DISPATCH(shade_block)(shader, material, points, views, lanes, visibility, shaded);
}

}  // namespace delray::shading
#endif
