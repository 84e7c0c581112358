#include "raytrace/answer.h"

#include <algorithm>
#include <tuple>

#include "raytrace/internal/hit_points.h"
#include "raytrace/intersection.h"
#include "raytrace/optics.h"
#include "shading/arithmetic.h"

namespace delray::raytrace {
namespace {

void occlude(const Tracer& tracer, ShadowGroup& group) {
  const shading::LaneMask active = active_lanes(group.active);
  SeeThrough passed[kPacketRays];
  tracer.embree.occluded(group.active, group.packet, passed, group.coherent);
  group.lit = group.dimmed = 0;
  for (int i = 0; i < kPacketRays; ++i) {
    group.lit |= group.packet.far[i] >= 0.0F ? 1U << i : 0U;
  }
  group.lit &= active;
  if (!tracer.embree.has_see_through()) return;
  for (int i = 0; i < kPacketRays; ++i) {
    if ((group.lit >> i & 1) == 0 || passed[i].count == 0) continue;
    const glm::vec3 direction(group.packet.direction_x[i], group.packet.direction_y[i],
                              group.packet.direction_z[i]);
    Layer layers[SeeThrough::kMost];
    const auto count = static_cast<std::size_t>(passed[i].count);
    for (std::size_t k = 0; k < count; ++k) {
      layers[k] = layer_of(tracer.placements, tracer.shader, passed[i].hits[k], direction,
                           (group.through_glass >> i & 1) != 0);
    }
    group.dimmed |= 1U << i;
    group.left.set(i, left_by({layers, count}));
  }
}

}  // namespace

void answer(const Tracer& tracer, Wave& wave) {
  const RayGroup* before = nullptr;
  for (RayGroup& group : wave.rays) {
    if (group.misses) continue;
    tracer.embree.intersect(group.active, group.packet, group.coherent);
    if (!tracer.large) continue;
    fetch_corners(tracer.placements, group);
    if (before != nullptr) fetch_vertices(tracer.placements, *before);
    before = &group;
  }
  if (before != nullptr) fetch_vertices(tracer.placements, *before);
  for (RayGroup& group : wave.rays) {
    group.hits = 0;
    if (!group.misses) find_points(tracer.placements, group);
  }
  for (ShadowGroup& group : wave.shadows) occlude(tracer, group);
}

Layer layer_of(std::span<const Placement> placements, const shading::Shader& shader, const Hit& hit,
               const glm::vec3& direction, bool through_glass) {
  const Placement& placement = placements[hit.placement];
  const scenes::Material& material = shader.materials[placement.material];
  if (!through_glass || !(material.transmission > 0.0F)) {
    const CoveragePoint at = coverage_point(placement, hit);
    const float alpha = shading::coverage(shader, material, at.uv, {}, at.alpha);
    return {hit.distance, hit.placement, hit.triangle, glm::vec3(1.0F - alpha)};
  }
  const Intersection at = intersection(placement, hit, direction, {0.0F});
  const glm::vec3 view = -direction;
  const shading::Surface s = shading::evaluate(shader, material, at.point, view);
  const float share = shading::clamp01(s.transmission) * (1.0F - shading::clamp01(s.metallic));
  const float reflected = refracted(view, s.normal, s.front ? 1.0F / s.ior : s.ior).reflected;
  return {hit.distance, hit.placement, hit.triangle,
          glm::vec3(1.0F - s.alpha) + s.base_colour * (s.alpha * share * (1.0F - reflected))};
}

glm::vec3 left_by(std::span<Layer> layers) {
  std::sort(layers.begin(), layers.end(), [](const Layer& a, const Layer& b) {
    return std::tie(a.distance, a.placement, a.triangle) <
           std::tie(b.distance, b.placement, b.triangle);
  });
  glm::vec3 left(1.0F);
  for (const Layer& layer : layers) left *= layer.left;
  return left;
}

}  // namespace delray::raytrace
