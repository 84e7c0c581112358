// Intersects the groups of a batch in place, as over a scene that a rank has whole, then looks for
// boxes of clusters elsewhere that a ray enters before its hit, first for a group at once. A ray
// that enters one becomes a message; what it has met at home stays in its lane, unless something
// nearer comes back.
//
// Degenerate: shadow rays that end at home need not travel; those that travel take the layers along
// that they have passed, as they are multiplied in one order.
#include "raytrace/distributed/batch_rays.h"

#include <algorithm>
#include <bit>

namespace delray::raytrace {
namespace {

using shading::LaneMask;

template <class Packet>
Line line_of(const Packet& packet, int i) {
  const glm::vec3 direction(packet.direction_x[i], packet.direction_y[i], packet.direction_z[i]);
  return {{packet.origin_x[i], packet.origin_y[i], packet.origin_z[i]},
          glm::vec3(1.0F) / direction,
          packet.near[i],
          packet.far[i]};
}

template <class Packet>
LinePacket lines_of(const Packet& packet, LaneMask active) {
  static_assert(LinePacket::kLines == kPacketRays);
  return {{packet.origin_x, packet.origin_y, packet.origin_z},
          {packet.direction_x, packet.direction_y, packet.direction_z},
          packet.near,
          packet.far,
          active};
}

template <class Packet>
TravellingRay travelling_ray(const Packet& packet, int i, const Progression& way) {
  return {way,
          {packet.origin_x[i], packet.origin_y[i], packet.origin_z[i]},
          packet.near[i],
          {packet.direction_x[i], packet.direction_y[i], packet.direction_z[i]}};
}

ReturnAddress lane_of(ReturnAddress address, std::uint32_t group, int i, bool coherent) {
  address.group = group;
  address.lane = static_cast<std::uint8_t>(i);
  address.coherent = coherent ? 1 : 0;
  return address;
}

// Hits of the packet as they are in the whole scene.
void renumber(const LocalScene& scene, RayGroup& group) {
  for (LaneMask rest = group.hits; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const Hit hit = in_whole_scene(hit_of(group.packet, i), scene.numbers);
    group.packet.triangle[i] = hit.triangle;
    group.packet.geometry[i] = hit.instance;
    group.packet.instance[i] = kMiss;
  }
}

void send_undecided(const HomeScene& home, const ReturnAddress& address, std::uint32_t number,
                    const RayGroup& group, RayQueue& travelling) {
  const LaneMask undecided =
      home.elsewhere.hit_lines(lines_of(group.packet, active_lanes(group.active)));
  for (LaneMask rest = undecided; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    Progression way = home.router.start();
    home.router.choose_next(line_of(group.packet, i), way);
    if (way.next == kMiss) continue;
    RayMessage& ray = travelling.rays.emplace_back();
    ray.return_address = lane_of(address, number, i, group.coherent);
    ray.nearest.far = group.packet.far[i];
    if ((group.hits >> i & 1) != 0) {
      ray.nearest.instance = group.packet.geometry[i];
      ray.nearest.triangle = group.packet.triangle[i];
    }
    ray.ray = travelling_ray(group.packet, i, way);
    ray.view = group.view.get(i);
    ray.width = group.width[i];
    ray.spread = group.spread[i];
  }
}

// Returns the lanes that are sent.
LaneMask send_undecided(const HomeScene& home, const ReturnAddress& address, std::uint32_t number,
                        const ShadowGroup& group, std::span<const SeeThrough, kPacketRays> passed,
                        RayQueue& travelling) {
  const LaneMask undecided = home.elsewhere.hit_lines(lines_of(group.packet, group.lit));
  LaneMask sent = 0;
  for (LaneMask rest = undecided; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    Progression way = home.router.start();
    home.router.choose_next(line_of(group.packet, i), way);
    if (way.next == kMiss) continue;
    sent |= 1U << i;
    ShadowMessage& shadow = travelling.shadows.emplace_back();
    const bool through_glass = (group.through_glass >> i & 1) != 0;
    shadow.return_address = lane_of(address, number, i, group.coherent);
    shadow.return_address.through_glass = through_glass ? 1 : 0;
    shadow.ray = travelling_ray(group.packet, i, way);
    shadow.far = group.packet.far[i];
    for (int k = 0; k < passed[i].count; ++k) {
      shadow.layers.push_back(layer_in_whole_scene(home.resident, passed[i].hits[k],
                                                   shadow.ray.direction, through_glass));
    }
    shadow.return_address.layers = static_cast<std::uint8_t>(shadow.layers.size());
  }
  return sent;
}

}  // namespace

std::uint64_t intersect_at_home(const HomeScene& home, const ReturnAddress& address,
                                RayBatch& batch, RayQueue& travelling) {
  std::uint64_t rays = 0;
  for (RayGroup& group : batch.rays) group.points.coloured = false;
  intersect_rays(home.resident, batch);
  for (std::uint32_t g = 0; g < batch.rays.size(); ++g) {
    RayGroup& group = batch.rays[g];
    if (group.misses) continue;
    rays += static_cast<std::uint64_t>(std::popcount(active_lanes(group.active)));
    renumber(home.resident, group);
    if (!home.elsewhere.empty()) send_undecided(home, address, g, group, travelling);
  }
  for (std::uint32_t g = 0; g < batch.shadows.size(); ++g) {
    ShadowGroup& group = batch.shadows[g];
    rays += static_cast<std::uint64_t>(std::popcount(active_lanes(group.active)));
    SeeThrough passed[kPacketRays];
    trace_shadows(home.resident, group.coherent && !home.kernels.has_instances, group, passed);
    if (!home.elsewhere.empty()) {
      group.lit &= ~send_undecided(home, address, g, group, passed, travelling);
    }
    attenuate(home.resident, home.shader, passed, group.lit, group);
  }
  return rays;
}

void deliver(const RayMessage& ray, RayBatch& batch) {
  if (ray.return_address.found == 0) return;
  RayGroup& group = batch.rays[ray.return_address.group];
  const int i = ray.return_address.lane;
  group.packet.far[i] = ray.nearest.far;
  group.packet.u[i] = ray.hit->u;
  group.packet.v[i] = ray.hit->v;
  group.packet.triangle[i] = ray.nearest.triangle;
  group.packet.geometry[i] = ray.nearest.instance;
  group.packet.instance[i] = kMiss;
  group.hits |= 1U << i;
  group.material[i] = ray.hit->material;
  group.offset[i] = ray.hit->offset;
  if (ray.return_address.coloured != 0 && !group.points.coloured) {
    group.points.coloured = true;
    for (int k = 0; k < kPacketRays; ++k) {
      group.points.colour.set(k, glm::vec3(1.0F));
      group.points.colour_alpha[k] = 1.0F;
    }
  }
  shading::set_point(group.points, i, ray.hit->point);
}

void deliver(const ShadowMessage& shadow, RayBatch& batch) {
  if (shadow.return_address.occluded != 0) return;
  ShadowGroup& group = batch.shadows[shadow.return_address.group];
  const int i = shadow.return_address.lane;
  group.lit |= 1U << i;
  if (shadow.layers.empty()) return;
  std::vector<Layer> layers = shadow.layers;
  group.attenuated |= 1U << i;
  group.transmittance.set(i, transmittance_of(layers));
}

}  // namespace delray::raytrace
