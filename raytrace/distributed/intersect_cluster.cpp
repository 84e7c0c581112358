// Intersects rays with clusters in packets of sixteen, and keeps the nearest hits and the layers
// that shadow rays pass.
#include "raytrace/distributed/intersect_cluster.h"

#include <algorithm>
#include <type_traits>
#include <vector>

#include "raytrace/scene/edges.h"
#include "raytrace/scene/hit_points.h"

namespace delray::raytrace {
namespace {

template <class Packet>
void set_line(Packet& packet, int i, const TravellingRay& ray) {
  packet.origin_x[i] = ray.origin.x, packet.origin_y[i] = ray.origin.y;
  packet.origin_z[i] = ray.origin.z;
  packet.near[i] = ray.near;
  packet.direction_x[i] = ray.direction.x, packet.direction_y[i] = ray.direction.y;
  packet.direction_z[i] = ray.direction.z;
}

void set_lane(RayGroup& group, int i, const RayMessage& ray) {
  RayPacket& p = group.packet;
  group.active.ray[i] = -1;
  set_line(p, i, ray.ray);
  p.time[i] = 0.0F;
  p.far[i] = a_little_further(ray.nearest.far);  // hits at the same distance count
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

// The hits of a packet that are nearer than what the rays have; those of other lanes are left
// alone.
bool keep_nearer(const LocalScene& scene, RayGroup& group, std::span<RayMessage* const> rays) {
  bool any = false;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const int i = static_cast<int>(k);
    NearestHit& nearest = rays[k]->nearest;
    bool nearer = group.packet.triangle[i] != kMiss;
    if (nearer) {
      const Hit hit = in_whole_scene(hit_of(group.packet, i), scene.numbers);
      nearer = is_nearer(hit, {nearest.far, nearest.instance, nearest.triangle});
      if (nearer) nearest = {hit.distance, hit.instance, hit.triangle};
    }
    if (!nearer) group.active.ray[i] = 0;
    any = any || nearer;
  }
  return any;
}

// Sixteen rays at most that are traced by the same kernel.
void intersect(const LocalScene& scene, std::span<RayMessage* const> rays, bool coherent) {
  RayGroup group;
  group.coherent = coherent;
  for (int i = 0; i < kPacketRays; ++i) group.active.ray[i] = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) set_lane(group, static_cast<int>(i), *rays[i]);
  scene.embree.intersect(group.active, group.packet, coherent);
  if (!keep_nearer(scene, group, rays)) return;
  find_points(scene.instances, group);
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const int i = static_cast<int>(k);
    if (group.active.ray[i] == 0) continue;
    const GeometryInstance& instance = scene.instances[hit_of(group.packet, i).instance];
    ReturnAddress& address = rays[k]->return_address;
    address.found = 1;
    address.coloured = group.points.coloured ? 1 : 0;
    address.second_uvs = instance.texture_sets > 1 ? 1 : 0;
    if (rays[k]->hit == nullptr) rays[k]->hit = std::make_unique<HitPoint>();
    *rays[k]->hit = {group.packet.u[i], group.packet.v[i], group.material[i], group.offset[i],
                     point_of(group.points, i)};
  }
}

void add_layer(const Layer& layer, ShadowMessage& shadow) {
  for (const Layer& known : shadow.layers) {
    if (known.instance == layer.instance && known.triangle == layer.triangle) return;
  }
  if (shadow.layers.size() == SeeThrough::kMost) {
    shadow.return_address.occluded = 1;
    return;
  }
  shadow.layers.push_back(layer);
  shadow.return_address.layers = static_cast<std::uint8_t>(shadow.layers.size());
}

void intersect(const LocalScene& scene, const Kernels& kernels,
               std::span<ShadowMessage* const> shadows, bool coherent) {
  ShadowPacket packet{};
  ActiveRays active;
  SeeThrough passed[kPacketRays];
  for (int i = 0; i < kPacketRays; ++i) active.ray[i] = 0;
  for (std::size_t k = 0; k < shadows.size(); ++k) {
    const int i = static_cast<int>(k);
    active.ray[i] = -1;
    set_line(packet, i, shadows[k]->ray);
    packet.far[i] = shadows[k]->far;
    packet.mask[i] = 0xFFFFFFFFU;
  }
  scene.embree.occluded(active, packet, passed, coherent && !kernels.has_instances);
  for (std::size_t k = 0; k < shadows.size(); ++k) {
    ShadowMessage& shadow = *shadows[k];
    shadow.return_address.occluded = packet.far[k] < 0.0F ? 1 : 0;
    for (int j = 0; j < passed[k].count && shadow.return_address.occluded == 0; ++j) {
      add_layer(layer_in_whole_scene(scene, passed[k].hits[j], shadow.ray.direction,
                                     shadow.return_address.through_glass != 0),
                shadow);
    }
  }
}

}  // namespace

void intersect_clusters(const ClusterScene& clusters, const shading::Shader& shader,
                        const Kernels& kernels, std::span<RayMessage> rays,
                        std::span<ShadowMessage> shadows) {
  const LocalScene scene = clusters.local(shader);
  // Packets of sixteen, which whoever traces them fills as it likes.
  const auto in_packets = [](auto all, auto&& intersect_packet) {
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
  in_packets(rays, [&](auto packet, bool coherent) { intersect(scene, packet, coherent); });
  in_packets(shadows,
             [&](auto packet, bool coherent) { intersect(scene, kernels, packet, coherent); });
}

}  // namespace delray::raytrace
