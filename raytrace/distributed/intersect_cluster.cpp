// Intersects rays with one cluster in packets of sixteen, and keeps the nearest hits and the layers
// that shadow rays pass.
#include "raytrace/distributed/intersect_cluster.h"

#include <algorithm>
#include <tuple>

#include "raytrace/scene/edges.h"
#include "raytrace/scene/hit_points.h"

namespace delray::raytrace {
namespace {

void set_lane(RayGroup& group, int i, const RayMessage& ray) {
  RayPacket& p = group.packet;
  group.active.ray[i] = -1;
  p.origin_x[i] = ray.origin.x, p.origin_y[i] = ray.origin.y, p.origin_z[i] = ray.origin.z;
  p.near[i] = ray.near;
  p.direction_x[i] = ray.direction.x, p.direction_y[i] = ray.direction.y;
  p.direction_z[i] = ray.direction.z;
  p.time[i] = 0.0F;
  p.far[i] = a_little_further(ray.far);  // hits at the same distance count
  p.mask[i] = 0xFFFFFFFFU;
  p.id[i] = p.flags[i] = 0;
  p.triangle[i] = p.geometry[i] = p.instance[i] = kMiss;
  group.view.set(i, ray.view);
  group.width[i] = ray.width;
  group.spread[i] = ray.spread;
}

shading::Point point_of(const shading::Points& p, int i) {
  shading::Point point;
  point.position = p.position.get(i);
  point.geometric_normal = p.geometric_normal.get(i);
  point.normal = p.normal.get(i);
  point.tangent = glm::vec4(p.tangent.get(i), p.handedness[i]);
  const shading::TexturePoint first = p.uvs[0].get(i);
  point.uv = first.uv;
  point.footprint = first.footprint;
  point.second = p.uvs[1].get(i);
  if (p.coloured) point.colour = glm::vec4(p.colour.get(i), p.colour_alpha[i]);
  return point;
}

// Sixteen rays at most that are traced by the same kernel.
void intersect(const Cluster& cluster, std::span<RayMessage* const> rays, bool coherent) {
  RayGroup group;
  group.coherent = coherent;
  for (int i = 0; i < kPacketRays; ++i) group.active.ray[i] = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) set_lane(group, static_cast<int>(i), *rays[i]);
  cluster.embree().intersect(group.active, group.packet, coherent);
  bool any = false;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const int i = static_cast<int>(k);
    RayMessage& ray = *rays[k];
    bool nearer = group.packet.triangle[i] != kMiss;
    if (nearer) {
      const Hit hit = hit_of(group.packet, i);
      const std::uint32_t instance = cluster.instance(hit.instance);
      const std::uint32_t triangle = cluster.triangle(hit.instance, hit.triangle);
      nearer = std::tie(hit.distance, instance, triangle) <
               std::tie(ray.far, ray.instance, ray.triangle);
      if (nearer) {
        ray.far = hit.distance;
        ray.instance = instance;
        ray.triangle = triangle;
        ray.u = hit.u;
        ray.v = hit.v;
      }
    }
    if (!nearer) group.active.ray[i] = 0;
    any = any || nearer;
  }
  if (!any) return;
  find_points(cluster.instances(), group);
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const int i = static_cast<int>(k);
    if (group.active.ray[i] == 0) continue;
    rays[k]->point = point_of(group.points, i);
    rays[k]->return_address.coloured = group.points.coloured ? 1 : 0;
    const GeometryInstance& instance = cluster.instances()[hit_of(group.packet, i).instance];
    rays[k]->return_address.second_uvs = instance.texture_sets > 1 ? 1 : 0;
    rays[k]->offset = group.offset[i];
    rays[k]->material = group.material[i];
  }
}

void add_layer(const Layer& layer, ShadowMessage& shadow) {
  for (int i = 0; i < shadow.layers; ++i) {
    const Layer& known = shadow.layer[i];
    if (known.instance == layer.instance && known.triangle == layer.triangle) return;
  }
  if (shadow.layers == SeeThrough::kMost) {
    shadow.occluded = true;
    return;
  }
  shadow.layer[shadow.layers++] = layer;
}

void intersect(const Cluster& cluster, const shading::Shader& shader, const Kernels& kernels,
               std::span<ShadowMessage* const> shadows, bool coherent) {
  ShadowPacket packet{};
  ActiveRays active;
  SeeThrough passed[kPacketRays];
  for (int i = 0; i < kPacketRays; ++i) active.ray[i] = 0;
  for (std::size_t k = 0; k < shadows.size(); ++k) {
    const ShadowMessage& shadow = *shadows[k];
    const int i = static_cast<int>(k);
    active.ray[i] = -1;
    packet.origin_x[i] = shadow.origin.x, packet.origin_y[i] = shadow.origin.y;
    packet.origin_z[i] = shadow.origin.z;
    packet.near[i] = shadow.near;
    packet.direction_x[i] = shadow.direction.x, packet.direction_y[i] = shadow.direction.y;
    packet.direction_z[i] = shadow.direction.z;
    packet.far[i] = shadow.far;
    packet.mask[i] = 0xFFFFFFFFU;
  }
  cluster.embree().occluded(active, packet, passed, coherent && !kernels.has_instances);
  for (std::size_t k = 0; k < shadows.size(); ++k) {
    ShadowMessage& shadow = *shadows[k];
    shadow.occluded = packet.far[k] < 0.0F;
    for (int j = 0; j < passed[k].count && !shadow.occluded; ++j) {
      const Hit& hit = passed[k].hits[j];
      Layer layer = layer_of(cluster.instances(), shader, hit, shadow.direction,
                             shadow.return_address.through_glass != 0);
      layer.instance = cluster.instance(hit.instance);
      layer.triangle = cluster.triangle(hit.instance, hit.triangle);
      add_layer(layer, shadow);
    }
  }
}

}  // namespace

void intersect_cluster(const Cluster& cluster, const shading::Shader& shader,
                       const Kernels& kernels, RayQueue& waiting) {
  // Packets of sixteen, which whoever traces them fills as it likes.
  const auto in_packets = [](auto& all, auto&& intersect_packet) {
    std::vector<std::remove_reference_t<decltype(all.front())>*> some;
    for (const bool coherent : {false, true}) {
      some.clear();
      for (auto& ray : all)
        if ((ray.return_address.coherent != 0) == coherent) some.push_back(&ray);
      for (std::size_t i = 0; i < some.size(); i += kPacketRays) {
        intersect_packet(
            std::span(some).subspan(i, std::min<std::size_t>(kPacketRays, some.size() - i)),
            coherent);
      }
    }
  };
  in_packets(waiting.rays, [&](auto rays, bool coherent) { intersect(cluster, rays, coherent); });
  in_packets(waiting.shadows, [&](auto shadows, bool coherent) {
    intersect(cluster, shader, kernels, shadows, coherent);
  });
}

}  // namespace delray::raytrace
