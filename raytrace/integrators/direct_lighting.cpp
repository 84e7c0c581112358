// The loop of integrators without random paths: adds the light that arrived, then shades the hits
// bundle by bundle in one order, whatever groups rays were put in, so that sums have the same bits.
// A ray that meets a layer shades it by its alpha and continues behind it.
#include "raytrace/integrators/direct_lighting.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include "image/image.h"
#include "raytrace/integrators/enqueue.h"
#include "raytrace/integrators/lane_sums.h"
#include "raytrace/integrators/waiting_rays.h"
#include "raytrace/scene/same_material.h"

namespace delray::raytrace {
namespace {

using shading::LaneMask;

void multiply(const shading::Vectors16& by, shading::Vectors16& v) {
  for (int i = 0; i < kPacketRays; ++i) {
    v.x[i] *= by.x[i];
    v.y[i] *= by.y[i];
    v.z[i] *= by.z[i];
  }
}

}  // namespace

void DirectLighting::begin() {
  enqueued_.clear();
  enqueued_lights_.clear();
  std::fill_n(open_, kBundles, Open{});
  for (std::uint32_t block = 0; block < next_.rays.size(); ++block) {
    RayLanes& lanes = enqueued_.add();
    lanes.whole = true;
    lanes.block = block;
    lanes.bundle = Bundle::straight;
    lanes.has_throughput = false;
  }
}

void DirectLighting::count_waiting(std::span<std::uint32_t> by_block) {
  count_rays(batch_.rays, enqueued_, by_block);
  count_rays(batch_.shadows, enqueued_lights_, by_block);
}

RayCounts DirectLighting::write_waiting(std::span<const std::uint8_t> moved, RayWriter& to) {
  RayCounts counts;
  write_rays(batch_.rays, enqueued_, moved, to, [&](const RayLanes& lanes, int i) {
    ++(depth_of(lanes, i) == context_.options.depth ? counts.primary : counts.secondary);
  });
  write_rays(batch_.shadows, enqueued_lights_, moved, to,
             [&](const Light&, int) { ++counts.shadow; });
  return counts;
}

void DirectLighting::read_waiting(RayReader& from) {
  read_rays(from, batch_.rays, enqueued_);
  read_rays(from, batch_.shadows, enqueued_lights_);
}

void DirectLighting::shade() {
  std::swap(enqueued_, intersected_);
  std::swap(enqueued_lights_, intersected_lights_);
  enqueued_.clear();
  enqueued_lights_.clear();
  std::fill_n(open_, kBundles, Open{});
  add_lights();
  // Bundle by bundle, so that the rays of a sample have one order however groups were filled.
  for (int bundle = 0; bundle < kBundles; ++bundle) {
    for (std::size_t g = 0; g < batch_.rays.size(); ++g) {
      if (intersected_[g].bundle != static_cast<Bundle>(bundle)) continue;
      RayGroup& group = batch_.rays[g];
      source_ = g;
      // Once for each ray, as two rays of one sample may or may not share a group.
      LaneMask shown = show_environment(group, intersected_[g]);
      if (group.hits != 0) shown |= shade_group(group, intersected_[g], shown_);
      if (shown != 0) add(intersected_[g], shown, shown_.colour);
    }
  }
}

// A ray's lights are summed before they are added to its sample, so that it makes no difference
// which rays share a group.
void DirectLighting::add_lights() {
  for (std::size_t g = 0; g < batch_.shadows.size();) {
    const Light& first = intersected_lights_[g];
    sum_ = {};
    LaneMask lit = 0;
    for (; g < batch_.shadows.size() && intersected_lights_[g].source == first.source; ++g) {
      const ShadowGroup& group = batch_.shadows[g];
      shading::Vectors16& reflected = intersected_lights_[g].reflected;
      for (LaneMask rest = group.attenuated; rest != 0; rest &= rest - 1) {
        const int i = std::countr_zero(rest);
        reflected.set(i, reflected.get(i) * group.transmittance.get(i));
      }
      add_lanes(reflected, group.lit, sum_);
      lit |= group.lit;
    }
    if (first.whole) {
      add_lanes(sum_, lit, samples_[first.block].colour);
      continue;
    }
    for (LaneMask rest = lit; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      SampleBlock& block = samples_[first.pixel[i] / kPacketRays];
      const int lane = static_cast<int>(first.pixel[i] % kPacketRays);
      block.colour.set(lane, block.colour.get(lane) + sum_.get(i));
    }
  }
}

LaneMask DirectLighting::show_environment(const RayGroup& group, const RayLanes& lanes) {
  LaneMask missed = active_lanes(group.active) & ~group.hits;
  if (missed == 0) return 0;
  if (context_.options.background == TraceOptions::Background::transparent) {
    // Primary rays make the picture transparent.
    for (LaneMask rest = missed; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      if (depth_of(lanes, i) != context_.options.depth) continue;
      const std::uint32_t pixel = lanes.pixel_of(i);
      samples_[pixel / kPacketRays].alpha[static_cast<int>(pixel % kPacketRays)] =
          1.0F - lanes.throughput_of(i).x;
      missed &= ~(1U << i);
    }
  }
  if (missed == 0 || context_.shader.shader->environment.black) return 0;
  negate_lanes(group.view, directions_);
  shading::environment_radiance(context_.shader, directions_, 0.0F, missed, shown_.colour);
  return missed;
}

LaneMask DirectLighting::evaluate_hits(const RayGroup& group, RayLanes& lanes,
                                       shading::Surfaces& surfaces) {
  for (LaneMask rest = group.hits; rest != 0;) {
    const LaneMask same = same_material(group, rest);
    shading::evaluate(context_.shader, group.material[std::countr_zero(rest)], group.points,
                      group.view, same, surfaces);
    rest &= ~same;
  }
  return see(group, lanes, surfaces.alpha);
}

LaneMask DirectLighting::see(const RayGroup& group, RayLanes& lanes,
                             const shading::Floats16& alpha) {
  LaneMask layered = 0;
  for (LaneMask rest = group.hits; rest != 0;) {
    const LaneMask same = same_material(group, rest);
    const auto& material = context_.shader.material(group.material[std::countr_zero(rest)]);
    if (material.material.alpha != scenes::Material::Alpha::opaque) layered |= same;
    rest &= ~same;
  }
  const LaneMask hidden = layered != 0 ? enqueue_behind_layers(group, lanes, layered, alpha) : 0;
  const LaneMask seen = group.hits & ~hidden;
  if (lanes.whole) {  // the first that these pixels see
    choose_lanes(group.packet.far, image::kEmptyDepth, seen, samples_[lanes.block].depth);
    return seen;
  }
  for (LaneMask rest = seen; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const std::uint32_t pixel = lanes.pixel_of(i);
    float& depth = samples_[pixel / kPacketRays].depth[static_cast<int>(pixel % kPacketRays)];
    if (depth == image::kEmptyDepth) depth = group.packet.far[i];
  }
  return seen;
}

LaneMask DirectLighting::enqueue_behind_layers(const RayGroup& group, RayLanes& lanes,
                                               LaneMask layered, const shading::Floats16& alpha) {
  if (!lanes.has_throughput) {
    for (int i = 0; i < kPacketRays; ++i) lanes.throughput.set(i, glm::vec3(1.0F));
    lanes.has_throughput = true;
  }
  LaneMask hidden = 0;
  for (LaneMask rest = layered; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const Hit hit = hit_of(group.packet, i);
    const bool again =
        !lanes.whole && hit.instance == lanes.instance[i] && hit.triangle == lanes.triangle[i];
    const float covered = again ? 0.0F : alpha[i];
    const glm::vec3 throughput = lanes.throughput.get(i);
    enqueue_behind(group, lanes, i, throughput * (1.0F - covered));
    lanes.throughput.set(i, throughput * covered);
    if (!(covered > 0.0F)) hidden |= 1U << i;
  }
  return hidden;
}

void DirectLighting::enqueue_behind(const RayGroup& group, const RayLanes& lanes, int i,
                                    const glm::vec3& throughput) {
  const std::uint32_t layers = lanes.whole ? 1 : lanes.layers[i] + 1;
  if (brightest(throughput) < kLeastThroughput || layers >= kMostLayers) return;
  const RayPacket& packet = group.packet;
  const Hit hit = hit_of(packet, i);
  NextRay ray;
  ray.origin = {packet.origin_x[i], packet.origin_y[i], packet.origin_z[i]};
  ray.direction = {packet.direction_x[i], packet.direction_y[i], packet.direction_z[i]};
  ray.view = group.view.get(i);
  ray.near = next_up(hit.distance);
  ray.width = group.width[i];
  ray.spread = group.spread[i];
  ray.throughput = throughput;
  ray.pixel = lanes.pixel_of(i);
  ray.depth = depth_of(lanes, i);
  ray.branch = branch_of(lanes, i, Bundle::straight);
  ray.layers = layers;
  ray.instance = hit.instance;
  ray.triangle = hit.triangle;
  enqueue(ray, Bundle::straight);
}

void DirectLighting::add(const RayLanes& lanes, LaneMask mask, const shading::Vectors16& radiance) {
  if (lanes.whole && !lanes.has_throughput) {
    SampleBlock& block = samples_[lanes.block];
    add_lanes(radiance, mask, block.colour);
    return;
  }
  for (LaneMask rest = mask; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const std::uint32_t pixel = lanes.pixel_of(i);
    SampleBlock& block = samples_[pixel / kPacketRays];
    const int lane = static_cast<int>(pixel % kPacketRays);
    block.colour.set(lane, block.colour.get(lane) + radiance.get(i) * lanes.throughput_of(i));
  }
}

void DirectLighting::enqueue_lights(const RayGroup& group, const RayLanes& lanes, LaneMask mask,
                                    const shading::Surfaces& surfaces, const Mirrored& mirrored) {
  for (std::size_t l = 0; l < context_.shader.lights.size(); ++l) {
    if (context_.shader.lights[l].kind == scenes::Light::Kind::area) continue;
    enqueue_light(group, lanes, mask, l, surfaces);
  }
  enqueue_sized_lights(group, lanes, mask, surfaces, mirrored);
}

void DirectLighting::enqueue_light(const RayGroup& group, const RayLanes& lanes, LaneMask mask,
                                   std::size_t light, const shading::Surfaces& surfaces) {
  if (mask == 0) return;
  shading::Arriving& arriving = arriving_;
  const LaneMask reached =
      shading::reflect_light(context_.shader, light, surfaces, group.view, mask, arriving);
  if (reached == 0) return;
  for (int i = 0; i < kPacketRays; ++i) arriving.distance[i] *= kShadowReach;
  enqueue_shadows(group, lanes, reached, surfaces, arriving.direction, arriving.distance,
                  arriving.reflected, true);
}

void DirectLighting::enqueue_shadows(const RayGroup& group, const RayLanes& lanes, LaneMask mask,
                                     const shading::Surfaces& surfaces,
                                     const shading::Vectors16& directions,
                                     const shading::Floats16& distances,
                                     const shading::Vectors16& reflected, bool coherent) {
  rays_.shadow += static_cast<std::uint64_t>(std::popcount(mask));
  Light& light = enqueued_lights_.add();
  light.source = source_;
  light.whole = lanes.whole;
  light.block = lanes.block;
  if (!lanes.whole) std::copy_n(lanes.pixel, kPacketRays, light.pixel);
  light.reflected = reflected;
  if (lanes.has_throughput) multiply(lanes.throughput, light.reflected);
  ShadowGroup& shadows = next_.shadows.add();
  shadows.coherent = coherent;
  shadows.through_glass = shading::kAllLanes;
  ShadowPacket& packet = shadows.packet;
  const shading::Vectors16 &from = surfaces.position, &up = surfaces.geometric_normal;
  for (int i = 0; i < kPacketRays; ++i) {
    shadows.active.ray[i] = (mask >> i & 1) != 0 ? -1 : 0;
    packet.origin_x[i] = from.x[i] + up.x[i] * group.offset[i];
    packet.origin_y[i] = from.y[i] + up.y[i] * group.offset[i];
    packet.origin_z[i] = from.z[i] + up.z[i] * group.offset[i];
    packet.near[i] = 0.0F;
    packet.direction_x[i] = directions.x[i];
    packet.direction_y[i] = directions.y[i];
    packet.direction_z[i] = directions.z[i];
    packet.time[i] = 0.0F;
    packet.far[i] = distances[i];
    packet.mask[i] = 0xFFFFFFFFU;
    packet.flags[i] = 0;
  }
}

void DirectLighting::enqueue(const NextRay& ray, Bundle bundle) {
  Open& open = open_[static_cast<int>(bundle)];
  if (open.used == kPacketRays) {
    open = {next_.rays.size(), 0};
    RayGroup& fresh = next_.rays.add();
    clear_lanes(fresh);
    fresh.coherent = true;  // neighbours' rays are mirrored and refracted alike
    RayLanes& lanes = enqueued_.add();
    lanes.whole = false;
    lanes.bundle = bundle;
    lanes.has_throughput = true;
  }
  const int i = open.used++;
  RayGroup& group = next_.rays[open.group];
  set_ray(group, i, ray.origin, ray.direction, ray.view, ray.near);
  group.width[i] = ray.width;
  group.spread[i] = ray.spread;
  RayLanes& lanes = enqueued_[open.group];
  lanes.throughput.set(i, ray.throughput);
  lanes.pixel[i] = ray.pixel;
  lanes.depth[i] = ray.depth;
  lanes.branch[i] = ray.branch;
  lanes.layers[i] = ray.layers;
  lanes.instance[i] = ray.instance;
  lanes.triangle[i] = ray.triangle;
  ++(ray.depth == context_.options.depth ? rays_.primary : rays_.secondary);
}

}  // namespace delray::raytrace
