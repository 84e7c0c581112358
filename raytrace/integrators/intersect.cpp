// Intersects a batch with the geometry at hand. In large scenes the vertices of hits
// are fetched ahead, one group before they are used. Shadow rays multiply the transmittances of the
// layers that they passed in one order, since Embree reports them in any.
#include "raytrace/integrators/intersect.h"

#include <algorithm>
#include <bit>
#include <tuple>

#include "raytrace/integrators/glass_layers.h"
#include "raytrace/sampling/optics.h"
#include "raytrace/scene/hit_points.h"
#include "raytrace/scene/intersection.h"
#include "shading/arithmetic.h"

namespace delray::raytrace {

using shading::LaneMask;

namespace {

// Memory that is not written to before it is used.
template <class T>
union PerHit {
  PerHit() {}
  T element[kPacketRays * SeeThrough::kMost];
};

bool transmits(const LocalScene& scene, const Hit& hit) {
  return scene.shader.materials[scene.instances[hit.instance].material].transmission > 0.0F;
}

}  // namespace

void trace_shadows(const LocalScene& scene, bool coherent, ShadowGroup& group,
                   std::span<SeeThrough, kPacketRays> passed) {
  scene.embree.occluded(group.active, group.packet, passed, coherent);
  group.lit = group.attenuated = 0;
  for (int i = 0; i < kPacketRays; ++i) {
    group.lit |= group.packet.far[i] >= 0.0F ? 1U << i : 0U;
  }
  group.lit &= active_lanes(group.active);
}

void attenuate(const LocalScene& scene, const shading::BatchShader& shader,
               std::span<const SeeThrough, kPacketRays> passed, shading::LaneMask lanes,
               ShadowGroup& group) {
  if (!scene.embree.has_see_through()) return;
  PerHit<PaneHit> panes;
  PerHit<Layer> layers;
  std::size_t pane_count = 0, first = 0;
  for (LaneMask rest = lanes; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    if (passed[i].count == 0) continue;
    group.attenuated |= 1U << i;
    const glm::vec3 direction(group.packet.direction_x[i], group.packet.direction_y[i],
                              group.packet.direction_z[i]);
    for (int k = 0; k < passed[i].count; ++k) {
      const Hit& hit = passed[i].hits[k];
      Layer& layer = layers.element[first++];
      const bool through_glass = (group.through_glass >> i & 1) != 0;
      if (through_glass && transmits(scene, hit)) {
        layer.distance = hit.distance;
        panes.element[pane_count++] = {hit, direction, &layer.transmittance};
      } else {
        layer = layer_of(scene.instances, scene.shader, hit, direction, through_glass);
      }
      const Hit whole = in_whole_scene(hit, scene.numbers);
      layer.instance = whole.instance;
      layer.triangle = whole.triangle;
    }
  }
  if (pane_count != 0) find_transmittances(scene.instances, shader, {panes.element, pane_count});
  first = 0;
  for (LaneMask rest = group.attenuated; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const auto count = static_cast<std::size_t>(passed[i].count);
    group.transmittance.set(i, transmittance_of({layers.element + first, count}));
    first += count;
  }
}

namespace {

// Traces rays group by group, those of group g that active_of(g) says, and finds the points of all.
template <class F>
void find_hit_points(const LocalScene& scene, RayBatch& batch, F&& active_of) {
  const RayGroup* before = nullptr;
  for (std::size_t g = 0; g < batch.rays.size(); ++g) {
    RayGroup& group = batch.rays[g];
    if (group.misses) continue;
    if (const ActiveRays* active = active_of(g))
      scene.embree.intersect(*active, group.packet, group.coherent);
    if (!scene.large) continue;
    fetch_corners(scene.instances, group);
    if (before != nullptr) fetch_vertices(scene.instances, *before);
    before = &group;
  }
  if (before != nullptr) fetch_vertices(scene.instances, *before);
  for (RayGroup& group : batch.rays) {
    group.hits = 0;
    if (!group.misses) find_points(scene.instances, group);
  }
}

LocalScene whole_scene(const Tracer& tracer) {
  return {tracer.embree, tracer.instances, tracer.shader, {}, tracer.large};
}

}  // namespace

void intersect_rays(const LocalScene& scene, RayBatch& batch) {
  find_hit_points(scene, batch, [&](std::size_t g) { return &batch.rays[g].active; });
}

void intersect_rest(const Tracer& tracer, RayBatch& batch, std::span<const ActiveRays> left) {
  find_hit_points(whole_scene(tracer), batch,
                  [&](std::size_t g) { return active_lanes(left[g]) != 0 ? &left[g] : nullptr; });
}

void intersect(const Tracer& tracer, const shading::BatchShader& shader, RayBatch& batch) {
  const LocalScene scene = whole_scene(tracer);
  intersect_rays(scene, batch);
  for (ShadowGroup& group : batch.shadows) {
    SeeThrough passed[kPacketRays];
    trace_shadows(scene, group.coherent, group, passed);
    attenuate(scene, shader, passed, group.lit, group);
  }
}

Layer layer_of(std::span<const GeometryInstance> instances, const shading::Shader& shader,
               const Hit& hit, const glm::vec3& direction, bool through_glass) {
  const GeometryInstance& instance = instances[hit.instance];
  const scenes::Material& material = shader.materials[instance.material];
  if (!through_glass || !(material.transmission > 0.0F)) {
    const std::uint32_t texture = material.base_colour_texture;
    const int set = texture == scenes::kNone ? 0 : shader.textures[texture].set;
    const CoveragePoint at = coverage_point(instance, hit, set);
    const float alpha = shading::coverage(shader, material, at.uv, {}, at.alpha);
    return {hit.distance, hit.instance, hit.triangle, glm::vec3(1.0F - alpha)};
  }
  const Intersection at = intersection(instance, hit, direction, {0.0F});
  const glm::vec3 view = -direction;
  const shading::Surface s = shading::evaluate(shader, material, at.point, view);
  const float share = shading::clamp01(s.transmission) * (1.0F - shading::clamp01(s.metallic));
  const float reflected = refracted(view, s.normal, s.front ? 1.0F / s.ior : s.ior).reflected;
  return {hit.distance, hit.instance, hit.triangle,
          glm::vec3(1.0F - s.alpha) +
              s.base_colour * s.attenuation * (s.alpha * share * (1.0F - reflected))};
}

Layer layer_in_whole_scene(const LocalScene& scene, const Hit& hit, const glm::vec3& direction,
                           bool through_glass) {
  Layer layer = layer_of(scene.instances, scene.shader, hit, direction, through_glass);
  const Hit whole = in_whole_scene(hit, scene.numbers);
  layer.instance = whole.instance;
  layer.triangle = whole.triangle;
  return layer;
}

glm::vec3 transmittance_of(std::span<Layer> layers) {
  std::sort(layers.begin(), layers.end(), [](const Layer& a, const Layer& b) {
    return std::tie(a.distance, a.instance, a.triangle) <
           std::tie(b.distance, b.instance, b.triangle);
  });
  glm::vec3 transmittance(1.0F);
  for (const Layer& layer : layers) transmittance *= layer.transmittance;
  return transmittance;
}

}  // namespace delray::raytrace
