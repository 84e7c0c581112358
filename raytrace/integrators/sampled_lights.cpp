// Shadow rays of `direct` and `whitted` to points that are drawn from lights with a size: area
// lights one by one, and what glows, of which one triangle at a time is drawn by its power. Each
// sample of a pixel draws its own points; pixels of few samples draw several for each of them.
//
// A lobe that is narrow beside a light is hardly ever hit by a point of it: such a highlight is
// what a mirrored ray sees where there is one, or else that of the light's centre.
#include <algorithm>
#include <bit>

#include "raytrace/integrators/direct_lighting.h"
#include "raytrace/integrators/enqueue.h"
#include "raytrace/integrators/lane_sums.h"

namespace delray::raytrace {
namespace {

using shading::LaneMask;

// Points that a pixel's samples draw of each light together, at least.
constexpr int kLeastPoints = 4;

// Roughness up to which a lobe is too narrow for samples of lights, and from which it is not.
constexpr float kNarrow = 0.15F, kWide = 0.25F;

float narrow_part(float roughness) {
  return shading::clamp01((kWide - roughness) * (1.0F / (kWide - kNarrow)));
}

bool positive(const glm::vec3& v) { return v.x > 0.0F || v.y > 0.0F || v.z > 0.0F; }

// Multiplies the specular lobes of a lane.
void dim_lobes(shading::Surfaces& surfaces, int i, float base, float coat) {
  surfaces.scale.set(i, surfaces.scale.get(i) * base);
  if ((surfaces.layered >> i & 1) != 0) surfaces.layers[i].coat *= coat;
}

}  // namespace

LaneMask DirectLighting::split_lobes(const shading::Surfaces& surfaces, LaneMask mask,
                                     const Mirrored& mirrored, shading::Surfaces& wide,
                                     shading::Surfaces& narrow) {
  wide = narrow = surfaces;
  LaneMask some = 0;
  for (LaneMask rest = mask; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const bool layered = (surfaces.layered >> i & 1) != 0;
    float base = mirrored.base[i], coat = mirrored.coat[i];
    const bool seen = base > 0.0F || coat > 0.0F;
    if (!seen) {
      base = narrow_part(surfaces.lobe_roughness[i]);
      coat = layered ? narrow_part(surfaces.layers[i].coat_roughness) : 0.0F;
    }
    dim_lobes(wide, i, 1.0F - base, 1.0F - coat);
    shading::remove_diffuse(narrow, i);
    dim_lobes(narrow, i, base, coat);
    if (base > 0.0F || coat > 0.0F) some |= 1U << i;
  }
  return some;
}

int DirectLighting::points_per_light() const {
  return std::clamp(kLeastPoints / std::max(1, context_.samples), 1, kLeastPoints);
}

void DirectLighting::draw_points(const RayLanes& lanes, LaneMask mask, std::size_t light, int point,
                                 std::span<Pairs16> pairs) {
  alignas(64) std::uint32_t pixels[kPacketRays];
  for (int i = 0; i < kPacketRays; ++i) pixels[i] = lanes.pixel_of(i);
  SampleLanes numbers;
  draw(pixels, mask, numbers);
  const auto lights = static_cast<std::uint32_t>(context_.shader.lights.size()) + 1;
  const auto points = static_cast<std::uint32_t>(points_per_light());
  for (int i = 0; i < kPacketRays; ++i) {
    const std::uint32_t surface = lanes.whole ? 0 : lanes.branch[i];
    numbers.sample[i] = numbers.sample[i] * points + static_cast<std::uint32_t>(point);
    numbers.dimension[i] +=
        (surface * lights + static_cast<std::uint32_t>(light)) * LightTable::kPairs;
  }
  sobol_pairs(numbers, pairs);
}

void DirectLighting::enqueue_points(const RayGroup& group, const RayLanes& lanes, LaneMask mask,
                                    const shading::Surfaces& surfaces, LightSamples& points) {
  const float share = 1.0F / static_cast<float>(points_per_light());
  shading::reflect(surfaces, group.view, points.direction, mask, reflected_);
  LaneMask reached = 0;
  for (LaneMask rest = mask; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const glm::vec3 light = reflected_.get(i) * points.weight.get(i) * share;
    reflected_.set(i, light);
    points.distance[i] *= kShadowReach;
    if (positive(light)) reached |= 1U << i;
  }
  if (reached == 0) return;
  enqueue_shadows(group, lanes, reached, surfaces, points.direction, points.distance, reflected_,
                  true);
}

void DirectLighting::enqueue_area_light(const RayGroup& group, const RayLanes& lanes, LaneMask mask,
                                        std::size_t light) {
  const auto number = static_cast<std::uint32_t>(light);
  Pairs16 places;
  for (int k = 0; k < points_per_light(); ++k) {
    draw_points(lanes, mask, light, k, std::span(&places, 1));
    LaneMask lit = 0;
    for (LaneMask rest = mask; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      const LightSample point =
          context_.lights.sample_area(number, wide_.position.get(i), {places.x[i], places.y[i]});
      points_.set(i, point);
      if (positive(point.weight)) lit |= 1U << i;
    }
    enqueue_points(group, lanes, lit, wide_, points_);
  }
}

void DirectLighting::enqueue_emission(const RayGroup& group, const RayLanes& lanes, LaneMask mask) {
  Pairs16 pairs[LightTable::kPairs];
  for (int k = 0; k < points_per_light(); ++k) {
    draw_points(lanes, mask, context_.shader.lights.size(), k, pairs);
    LaneMask lit = 0;
    for (LaneMask rest = mask; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      const LightSample point = context_.lights.sample_emission(
          *context_.shader.shader, wide_.position.get(i), {pairs[0].x[i], pairs[0].y[i]},
          {pairs[1].x[i], pairs[1].y[i]}, {pairs[2].x[i], pairs[2].y[i]});
      points_.set(i, point);
      if (positive(point.weight)) lit |= 1U << i;
    }
    enqueue_points(group, lanes, lit, wide_, points_);
  }
}

void DirectLighting::enqueue_sized_lights(const RayGroup& group, const RayLanes& lanes,
                                          LaneMask mask, const shading::Surfaces& surfaces,
                                          const Mirrored& mirrored) {
  const std::span<const shading::BatchLight> lights = context_.shader.lights;
  const bool area = std::ranges::any_of(lights, [](const shading::BatchLight& light) {
    return light.kind == scenes::Light::Kind::area;
  });
  if (!area && !context_.lights.emits()) return;
  const LaneMask narrow = split_lobes(surfaces, mask, mirrored, wide_, narrow_);
  LaneMask seen = 0;  // by mirrored rays
  for (LaneMask rest = narrow; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    if (mirrored.base[i] > 0.0F || mirrored.coat[i] > 0.0F) seen |= 1U << i;
  }
  for (std::size_t l = 0; l < lights.size(); ++l) {
    if (lights[l].kind != scenes::Light::Kind::area) continue;
    enqueue_area_light(group, lanes, mask, l);
    const bool met = context_.lights.has_lamp(static_cast<std::uint32_t>(l));
    enqueue_light(group, lanes, met ? narrow & ~seen : narrow, l, narrow_);
  }
  if (context_.lights.emits()) enqueue_emission(group, lanes, mask);
}

}  // namespace delray::raytrace
