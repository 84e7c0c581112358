// shade and directions_to of shading/batch.h, compiled once for each instruction set that Highway
// targets; the best one is chosen at run time.
//
// A block of 16 points goes through as vectors of lanes. The material decides which loop runs: for
// a grey specular lobe, for a coloured one that is the same at all points, or for one that varies.
// Materials with a coat or a sheen are composed of the functions in batch_parts.cpp.
#include "shading/batch.h"

#include <bit>
#include <cassert>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/lanes/batch.cpp"
#include <hwy/foreach_target.h>
// What is compiled per target comes after it.
#include <hwy/highway.h>

#include "shading/lanes/shade_lanes.h"
#include "shading/lanes/surface_lanes.h"

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
                     const F3& position, const F3& normal, const F3& view, int i,
                     std::span<const Vectors16> visibility) {
  F3 sum = set(glm::vec3(0.0F));
  for (std::size_t l = 0; l < shader.lights.size(); ++l) {
    if (shader.lights[l].dark) continue;
    const ReflectedLanes one = reflected(shader.lights[l], lobes, position, normal, view);
    const F3 all = visibility.empty() ? one.reflected : one.reflected * load(visibility[l], i);
    sum = sum + where(one.matters, all);
  }
  return sum;
}

// What one vector of points is shaded by.
struct Block {
  const BatchShader& shader;
  const BatchMaterial& material;
  const Points& points;
  std::span<const Vectors16> visibility;
};

// One vector of points from lane i on, as it is seen: the way to the viewer, and its cosine with
// the normal.
struct SeenLanes {
  int i;
  M active;
  F3 view;
  F cosine;
};

// The same whose lobes are known: `diffuse` is Lobes::diffuse.
template <class Reflectance>
struct LitLanes {
  const SurfaceLanes& surface;
  const F3& diffuse;
  F roughness;
  const LobeLanes<Reflectance>& lobes;
  const ResponseLanes<Reflectance>& response;
};

template <class Reflectance>
HWY_INLINE void shade_lit(const Block& block, const SeenLanes& seen,
                          const LitLanes<Reflectance>& lit, Shaded& shaded) {
  const auto& [surface, diffuse, roughness, lobes, response] = lit;
  const auto& [i, active, view, cosine] = seen;
  const Shader& scene = *block.shader.shader;
  F3 sum = surface.emission;
  if (!scene.environment.black) {
    sum = sum + diffuse * response.entering * diffuse_radiance(scene.environment, surface.normal);
    sum = sum + ambient_specular(scene, roughness, response.specular, surface.normal, view, cosine,
                                 active);
    if (block.material.material.transmission > 0.0F) {
      const F share = transmitted_share(surface.transmission, surface.metallic);
      const F3 tint = tint_of(block.material, surface.base_colour, surface.front);
      sum =
          sum + ambient_transmitted(scene, roughness, response.entering, tint, share, view, active);
    }
  }
  sum = sum + direct(block.shader, lobes, load(block.points.position, i), surface.normal, view, i,
                     block.visibility);
  store(sum, active, i, shaded.colour);
  store(surface.alpha, active, i, shaded.alpha);
}

HWY_NOINLINE void shade_grey(const Block& block, const Vectors16& views, LaneMask lane_mask,
                             Shaded& shaded) {
  const BatchMaterial& material = block.material;
  for (int i = 0; i < kBlockPoints; i += lanes()) {
    const M active = mask_of(lane_mask, i);
    if (hn::AllFalse(FloatTag(), active)) continue;
    const F3 view = load(views, i);
    const SurfaceLanes surface =
        evaluate(block.shader, material.material, block.points, view, i, active);
    const F cosine = dot(surface.normal, view);
    const F3 diffuse = diffuse_of(surface);
    const ResponseLanes<Grey> response =
        grey_response(material.lobes, constant_shares(material, clamp01(cosine)));
    const auto lobes = seen_lobes(material.lobes, diffuse, response, cosine);
    shade_lit<Grey>(block, {i, active, view, cosine},
                    {surface, diffuse, set(material.lobes.roughness), lobes, response}, shaded);
  }
}

template <bool kVarying>
HWY_NOINLINE void shade_coloured(const Block& block, const Vectors16& views, LaneMask lane_mask,
                                 Shaded& shaded) {
  const BatchMaterial& material = block.material;
  for (int i = 0; i < kBlockPoints; i += lanes()) {
    const M active = mask_of(lane_mask, i);
    if (hn::AllFalse(FloatTag(), active)) continue;
    const F3 view = load(views, i);
    const SurfaceLanes surface =
        evaluate(block.shader, material.material, block.points, view, i, active);
    const F cosine = dot(surface.normal, view);
    const LobesLanes lobes =
        kVarying ? varying_lobes(block.shader, material, surface, block.points, i, active)
                 : constant_lobes(material.lobes, diffuse_of(surface));
    const SharesLanes shares = kVarying ? varying_shares(lobes.roughness, clamp01(cosine))
                                        : constant_shares(material, clamp01(cosine));
    const ResponseLanes<Coloured> seen = response(lobes, shares);
    const auto lobes_seen = seen_lobes(lobes, seen, cosine);
    shade_lit<Coloured>(block, {i, active, view, cosine},
                        {surface, lobes.diffuse, lobes.roughness, lobes_seen, seen}, shaded);
  }
}

void shade_block(const BatchShader& shader, std::uint32_t number, const Points& points,
                 const Vectors16& views, LaneMask lane_mask, std::span<const Vectors16> visibility,
                 Shaded& shaded) {
  const Block block{shader, shader.material(number), points, visibility};
  switch (points.coloured ? block.material.coloured : block.material.plain) {
    case BatchMaterial::Specular::grey:
      return shade_grey(block, views, lane_mask, shaded);
    case BatchMaterial::Specular::coloured:
      return shade_coloured<false>(block, views, lane_mask, shaded);
    case BatchMaterial::Specular::varying:
      return shade_coloured<true>(block, views, lane_mask, shaded);
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

namespace {

void add(const Vectors16& some, LaneMask lanes, Vectors16& sum) {
  for (; lanes != 0; lanes &= lanes - 1) {
    const int i = std::countr_zero(lanes);
    sum.set(i, sum.get(i) + some.get(i));
  }
}

// Materials with a coat or a sheen, part by part.
void shade_layered(const BatchShader& shader, std::uint32_t material, const Points& points,
                   const Vectors16& views, LaneMask lanes, std::span<const Vectors16> visibility,
                   Shaded& shaded) {
  Surfaces surfaces;
  Vectors16 some, lit;
  Arriving arriving;
  evaluate(shader, material, points, views, lanes, surfaces);
  for (LaneMask rest = lanes; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    shaded.colour.set(i, surfaces.emission.get(i));
    shaded.alpha[i] = surfaces.alpha[i];
  }
  for (const auto part : {ambient_diffuse, ambient_specular, ambient_coat, ambient_transmitted}) {
    part(shader, surfaces, views, lanes, some);
    add(some, lanes, shaded.colour);
  }
  for (std::size_t l = 0; l < shader.lights.size(); ++l) {
    const LaneMask reached = reflect_light(shader, l, surfaces, views, lanes, arriving);
    for (LaneMask rest = visibility.empty() ? 0 : reached; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      arriving.reflected.set(i, arriving.reflected.get(i) * visibility[l].get(i));
    }
    add(arriving.reflected, reached, lit);
  }
  add(lit, lanes, shaded.colour);
}

}  // namespace

void shade(const BatchShader& shader, std::uint32_t material, const Points& points,
           const Vectors16& views, LaneMask lanes, std::span<const Vectors16> visibility,
           Shaded& shaded) {
  assert(visibility.empty() || visibility.size() == shader.lights.size());
  if (shader.material(material).layered) {
    shade_layered(shader, material, points, views, lanes, visibility, shaded);
    return;
  }
  HWY_DYNAMIC_DISPATCH(shade_block)(shader, material, points, views, lanes, visibility, shaded);
}

}  // namespace delray::shading
#endif
