#include "raytrace/whitted.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <tuple>

#include "raytrace/intersection.h"
#include "raytrace/optics.h"
#include "shading/shade.h"

namespace delray::raytrace {
namespace {

using shading::Incident;
using shading::Lobes;
using shading::Surface;

// A ray that could change the pixel by less than this is not sent.
constexpr float kLeastWeight = 1.0F / 256.0F;

// Roughness up to which a surface is a perfect mirror, and from which it is none.
constexpr float kMirror = 0.15F, kMatt = 0.5F;

// Lamps are modelled around their lights; a shadow ray ends a little before it gets there.
constexpr float kShadowReach = 1.0F - 0x1p-10F;

constexpr int kMostLayers = 64;  // of cut-outs and blended surfaces along one ray

float brightest(const glm::vec3& v) { return std::max(std::max(v.x, v.y), v.z); }

float next_up(float x) { return std::bit_cast<float>(std::bit_cast<std::uint32_t>(x) + 1); }

// A surface that a ray has met, ready for shading.
struct Met {
  Surface surface;
  Lobes lobes;
  glm::vec3 view{0.0F};  // unit vector back along the ray
  float offset = 0.0F;
  float width = 0.0F;  // of the ray's cone
};

// Everything along one ray: premultiplied colour, what is left of the light from behind, and the
// distance of the first layer.
struct Seen {
  glm::vec3 colour{0.0F};
  float through = 1.0F;
  float distance = image::kEmptyDepth;
};

class Walk {
 public:
  Walk(const Tracer& tracer, float spread, RayCounts& counts)
      : tracer_(tracer), spread_(spread), counts_(counts) {}

  const Placement& placement(const Hit& hit) const { return tracer_.placements[hit.placement]; }

  Met meet(const Hit& hit, const glm::vec3& direction, float width) const {
    const Placement& where = placement(hit);
    const Intersection at = intersection(where, hit, direction, {width});
    Met met;
    met.view = -direction;
    met.surface = shading::evaluate(tracer_.shader, tracer_.shader.materials[where.material],
                                    at.point, met.view);
    met.lobes = shading::lobes(met.surface);
    met.offset = at.offset;
    met.width = width;
    return met;
  }

  glm::vec3 before_lights(const Met& met) const {
    return met.surface.emission +
           shading::ambient_diffuse(tracer_.shader, met.surface, met.lobes, met.view);
  }

  // What the layers that a shadow ray passed leave of its light.
  glm::vec3 left_by(SeeThrough& passed, const glm::vec3& direction) const {
    std::sort(passed.hits, passed.hits + passed.count, [](const Hit& a, const Hit& b) {
      return std::tie(a.distance, a.placement, a.triangle) <
             std::tie(b.distance, b.placement, b.triangle);
    });
    glm::vec3 left(1.0F);
    for (int i = 0; i < passed.count; ++i) {
      const Met met = meet(passed.hits[i], direction, 0.0F);
      const Surface& s = met.surface;
      const float share = shading::clamp01(s.transmission) * (1.0F - shading::clamp01(s.metallic));
      const float reflected =
          refracted(met.view, s.normal, s.front ? 1.0F / s.ior : s.ior).reflected;
      left *= glm::vec3(1.0F - s.alpha) + s.base_colour * (s.alpha * share * (1.0F - reflected));
    }
    return left;
  }

  // What mirror and refraction rays see, weighted; `weight` is what the pixel makes of it.
  glm::vec3 around(const Met& met, int depth, float weight) {
    const Surface& s = met.surface;
    const float glass = shading::clamp01(s.transmission) * (1.0F - shading::clamp01(s.metallic));
    if (depth <= 0) {
      return shading::ambient_specular(tracer_.shader, s, met.lobes, met.view) +
             shading::ambient_transmitted(tracer_.shader, s, met.lobes, met.view);
    }
    glm::vec3 reflectance =
        shading::fresnel(met.lobes, shading::clamp01(glm::dot(s.normal, met.view)));
    // Inside glass there is no environment to stand in for a reflection.
    const bool inside = glass > 0.0F && !s.front;
    float mirror =
        inside ? 1.0F
               : shading::clamp01((kMatt - met.lobes.roughness) * (1.0F / (kMatt - kMirror)));
    Refraction refraction;
    if (glass > 0.0F) {
      refraction = refracted(met.view, s.normal, s.front ? 1.0F / s.ior : s.ior);
      reflectance += (glm::vec3(refraction.reflected) - reflectance) * glass;
    }
    glm::vec3 sum(0.0F);
    const float mirror_weight = weight * mirror * brightest(reflectance);
    if (mirror_weight >= kLeastWeight) {
      const glm::vec3 direction = kept_on_side(mirrored(met.view, s.normal), s.geometric_normal);
      sum += reflectance * mirror *
             radiance(s.position + s.geometric_normal * met.offset, direction, met.width, depth - 1,
                      mirror_weight);
    } else {
      mirror = 0.0F;
    }
    if (mirror < 1.0F && !inside) {
      sum += shading::ambient_specular(tracer_.shader, s, met.lobes, met.view) * (1.0F - mirror);
    }
    if (glass > 0.0F && refraction.reflected < 1.0F) {
      const glm::vec3 transmitted = s.base_colour * (glass * (1.0F - refraction.reflected));
      const float through_weight = weight * brightest(transmitted);
      if (through_weight >= kLeastWeight) {
        const glm::vec3 direction = kept_on_side(refraction.direction, -s.geometric_normal);
        sum += transmitted * radiance(s.position - s.geometric_normal * met.offset, direction,
                                      met.width, depth - 1, through_weight);
      }
    }
    return sum;
  }

  // Everything that leaves a surface towards the ray that met it.
  glm::vec3 leaving(const Met& met, int depth, float weight) {
    glm::vec3 sum = before_lights(met);
    sum += shading::direct(tracer_.shader, met.surface, met.lobes, met.view,
                           [&](std::size_t, const Incident& light) { return visible(met, light); });
    return sum + around(met, depth, weight);
  }

  // Follows a ray through its layers. `unit` is the ray's direction at length 1, `scale` the length
  // it has. Counts rays in `count`.
  Seen follow(Ray& ray, const glm::vec3& unit, float scale, float width, int depth, float weight,
              std::uint64_t& count) {
    Seen seen;
    Hit last;
    for (int layer = 0; layer < kMostLayers; ++layer) {
      tracer_.embree.intersect(ray);
      ++count;
      if (ray.triangle == kMiss) return seen;
      const Hit hit = hit_of(ray);
      const bool again = hit.placement == last.placement && hit.triangle == last.triangle;
      if (!again) {
        const Met met = meet(hit, unit, width + hit.distance * scale * spread_);
        const float share = seen.through * met.surface.alpha;
        if (share > 0.0F) {
          seen.colour += leaving(met, depth, weight * share) * share;
          if (seen.distance == image::kEmptyDepth) seen.distance = hit.distance;
        }
        seen.through *= 1.0F - met.surface.alpha;
        if (seen.through < kLeastWeight) break;
      }
      last = hit;
      ray.near = next_up(hit.distance);
      ray.far = std::numeric_limits<float>::infinity();
      ray.triangle = ray.geometry = ray.instance = kMiss;
    }
    seen.through = 0.0F;
    return seen;
  }

 private:
  static Ray ray_from(const glm::vec3& origin, const glm::vec3& direction) {
    Ray ray;
    ray.origin_x = origin.x, ray.origin_y = origin.y, ray.origin_z = origin.z;
    ray.direction_x = direction.x, ray.direction_y = direction.y, ray.direction_z = direction.z;
    ray.near = 0.0F;
    return ray;
  }

  glm::vec3 visible(const Met& met, const Incident& light) {
    Ray ray =
        ray_from(met.surface.position + met.surface.geometric_normal * met.offset, light.direction);
    ray.far = light.distance * kShadowReach;
    ++counts_.shadow;
    SeeThrough passed;
    if (tracer_.embree.occluded(ray, passed)) return glm::vec3(0.0F);
    return passed.count == 0 ? glm::vec3(1.0F) : left_by(passed, light.direction);
  }

  glm::vec3 radiance(const glm::vec3& origin, const glm::vec3& direction, float width, int depth,
                     float weight) {
    Ray ray = ray_from(origin, direction);
    const Seen seen = follow(ray, direction, 1.0F, width, depth, weight, counts_.secondary);
    if (seen.through <= 0.0F) return seen.colour;
    return seen.colour +
           shading::radiance(tracer_.shader.environment, tracer_.shader.textures, direction) *
               seen.through;
  }

  const Tracer& tracer_;
  float spread_;  // width that a cone gains per unit of distance
  RayCounts& counts_;
};

glm::vec3 direction_of(const RayPacket& packet, int i) {
  return {packet.direction_x[i], packet.direction_y[i], packet.direction_z[i]};
}

RayPacket primary_rays(const scenes::View& view, const Block& block) {
  RayPacket packet;
  for (int i = 0; i < kPacketRays; ++i) {
    const glm::vec3 direction =
        view.ray(static_cast<float>(block.x + i % kBlockSide) + block.offset.x,
                 static_cast<float>(block.y + i / kBlockSide) + block.offset.y);
    packet.origin_x[i] = view.eye.x;
    packet.origin_y[i] = view.eye.y;
    packet.origin_z[i] = view.eye.z;
    packet.near[i] = view.near;
    packet.direction_x[i] = direction.x;
    packet.direction_y[i] = direction.y;
    packet.direction_z[i] = direction.z;
    packet.time[i] = 0.0F;
    packet.far[i] = std::numeric_limits<float>::infinity();
    packet.mask[i] = 0xFFFFFFFFU;
    packet.id[i] = static_cast<std::uint32_t>(i);
    packet.flags[i] = 0;
    packet.triangle[i] = packet.geometry[i] = packet.instance[i] = kMiss;
  }
  return packet;
}

Ray single(const RayPacket& packet, int i) {
  Ray ray;
  ray.origin_x = packet.origin_x[i];
  ray.origin_y = packet.origin_y[i];
  ray.origin_z = packet.origin_z[i];
  ray.near = packet.near[i];
  ray.direction_x = packet.direction_x[i];
  ray.direction_y = packet.direction_y[i];
  ray.direction_z = packet.direction_z[i];
  return ray;
}

// Adds to `lit` what each met surface reflects of one light, as far as shadow rays reach it.
void add_light(const Tracer& tracer, const Walk& walk, const scenes::Light& light,
               const ActiveRays& hits, const Met* met, glm::vec3* lit, RayCounts& counts) {
  ShadowPacket packet{};
  ActiveRays active;
  glm::vec3 reflected[kPacketRays], direction[kPacketRays];
  std::uint64_t count = 0;
  for (int i = 0; i < kPacketRays; ++i) {
    active.ray[i] = 0;
    if (hits.ray[i] == 0) continue;
    const Surface& s = met[i].surface;
    const Incident arriving = shading::incident(light, s.position);
    reflected[i] = shading::reflect(met[i].lobes, s.normal, met[i].view, arriving.direction) *
                   arriving.irradiance;
    if (!(brightest(reflected[i]) > 0.0F)) continue;
    direction[i] = arriving.direction;
    const glm::vec3 origin = s.position + s.geometric_normal * met[i].offset;
    packet.origin_x[i] = origin.x;
    packet.origin_y[i] = origin.y;
    packet.origin_z[i] = origin.z;
    packet.near[i] = 0.0F;
    packet.direction_x[i] = arriving.direction.x;
    packet.direction_y[i] = arriving.direction.y;
    packet.direction_z[i] = arriving.direction.z;
    packet.time[i] = 0.0F;
    packet.far[i] = arriving.distance * kShadowReach;
    packet.mask[i] = 0xFFFFFFFFU;
    packet.flags[i] = 0;
    active.ray[i] = -1;
    ++count;
  }
  if (count == 0) return;
  counts.shadow += count;
  SeeThrough passed[kPacketRays];
  tracer.embree.occluded(active, packet, passed);
  for (int i = 0; i < kPacketRays; ++i) {
    if (active.ray[i] == 0 || packet.far[i] < 0.0F) continue;
    lit[i] +=
        passed[i].count == 0 ? reflected[i] : reflected[i] * walk.left_by(passed[i], direction[i]);
  }
}

}  // namespace

void trace_whitted(const Tracer& tracer, const scenes::View& view, const TraceOptions& options,
                   const Block& block, BlockResult& result, RayCounts& counts) {
  const bool transparent = options.background == TraceOptions::Background::transparent;
  Walk walk(tracer, 1.0F / view.scale, counts);
  RayPacket packet = primary_rays(view, block);
  tracer.embree.intersect(block.active, packet);

  const auto finish = [&](int i, const glm::vec3& colour, float through, const glm::vec3& direction,
                          float depth) {
    glm::vec3 sum = colour;
    float alpha = 1.0F - through;
    if (through > 0.0F && !transparent) {
      sum +=
          shading::radiance(tracer.shader.environment, tracer.shader.textures, direction) * through;
      alpha = 1.0F;
    }
    result.colour[i] = {sum.x, sum.y, sum.z, alpha};
    result.depth[i] = depth;
  };

  Met met[kPacketRays];
  ActiveRays hits;
  for (int i = 0; i < kPacketRays; ++i) {
    hits.ray[i] = 0;
    if (block.active.ray[i] == 0) continue;
    const glm::vec3 along = direction_of(packet, i);
    const float length = std::sqrt(glm::dot(along, along));
    const glm::vec3 unit = along * (1.0F / length);
    if (packet.triangle[i] == kMiss) {
      ++counts.primary;
      finish(i, glm::vec3(0.0F), 1.0F, unit, image::kEmptyDepth);
      continue;
    }
    const Hit hit = hit_of(packet, i);
    if (walk.placement(hit).layered) {
      Ray ray = single(packet, i);
      const Seen seen = walk.follow(ray, unit, length, 0.0F, options.depth, 1.0F, counts.primary);
      finish(i, seen.colour, seen.through, unit, seen.distance);
      continue;
    }
    ++counts.primary;
    met[i] = walk.meet(hit, unit, hit.distance / view.scale);
    hits.ray[i] = -1;
  }

  glm::vec3 lit[kPacketRays];
  for (glm::vec3& sum : lit) sum = glm::vec3(0.0F);
  for (const scenes::Light& light : tracer.shader.lights) {
    add_light(tracer, walk, light, hits, met, lit, counts);
  }
  for (int i = 0; i < kPacketRays; ++i) {
    if (hits.ray[i] == 0) continue;
    glm::vec3 sum = walk.before_lights(met[i]);
    sum += lit[i];
    sum += walk.around(met[i], options.depth, 1.0F);
    finish(i, sum, 0.0F, -met[i].view, packet.far[i]);
  }
}

}  // namespace delray::raytrace
