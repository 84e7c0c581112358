// Recursive ray tracing (Whitted 1980), breadth first: all mirrored and refracted rays of a task
// make the next batch.
//
// Reflectance goes by Schlick's approximation, glass by Fresnel's equations. Between a mirror and a
// matt surface a ray and the blurred environment share the reflection. Cost: up to two rays for
// each surface until `depth` or weight ends them, and shadow rays.
//
// Degenerate: inside of glass there is no environment to stand in; rays that could hardly change a
// sample are not sent.
#include "raytrace/integrators/whitted.h"

#include <algorithm>
#include <bit>

#include "raytrace/integrators/direct_lighting.h"
#include "raytrace/integrators/enqueue.h"
#include "raytrace/integrators/lane_sums.h"
#include "raytrace/sampling/optics.h"
#include "shading/shade.h"

namespace delray::raytrace {
namespace {

using shading::LaneMask;

// Roughness up to which a surface is a perfect mirror, and from which it is none.
constexpr float kMirror = 0.15F, kMatt = 0.5F;

class Whitted final : public DirectLighting {
 public:
  using DirectLighting::DirectLighting;

 private:
  LaneMask shade_group(RayGroup& group, RayLanes& lanes, shading::Shaded& shown) override {
    const LaneMask seen = evaluate_hits(group, lanes, surfaces_);
    if (seen == 0) return 0;
    absorb(group, lanes, seen);
    shading::Vectors16 &sum = shown.colour, &colour = colour_;
    copy_lanes(surfaces_.emission, seen, sum);
    shading::ambient_diffuse(context_.shader, surfaces_, group.view, seen, colour);
    add_lanes(colour, seen, sum);

    // How much of the blurred reflection of the environment each lane shows.
    shading::Floats16 blurred;
    Mirrored mirrored;
    LaneMask some = 0, ended = 0;
    for (LaneMask rest = seen; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      blurred_coat_[i] = 1.0F;
      if (depth_of(lanes, i) <= 0) {
        ended |= 1U << i;
        blurred[i] = 1.0F;
      } else {
        blurred[i] = enqueue_around(group, lanes, i);
      }
      some |= blurred[i] > 0.0F ? 1U << i : 0U;
      mirrored.base[i] = 1.0F - blurred[i];
      mirrored.coat[i] = 1.0F - blurred_coat_[i];
    }
    enqueue_lights(group, lanes, seen, surfaces_, mirrored);
    if (some != 0) {
      shading::ambient_specular(context_.shader, surfaces_, group.view, some, colour);
      for (int i = 0; i < kPacketRays; ++i) {
        colour.x[i] *= blurred[i];
        colour.y[i] *= blurred[i];
        colour.z[i] *= blurred[i];
      }
      add_lanes(colour, some, sum);
    }
    if (ended != 0) {
      shading::ambient_transmitted(context_.shader, surfaces_, group.view, ended, colour);
      add_lanes(colour, ended, sum);
    }
    if ((surfaces_.layered & seen) != 0) {
      shading::ambient_coat(context_.shader, surfaces_, group.view, seen, colour);
      for (int i = 0; i < kPacketRays; ++i) colour.set(i, colour.get(i) * blurred_coat_[i]);
      add_lanes(colour, seen & surfaces_.layered, sum);
    }
    return seen;
  }

  // Asks for the mirrored and the refracted ray of a lane. Returns the part of the reflection that
  // neither of them sees.
  float enqueue_around(const RayGroup& group, const RayLanes& lanes, int i) {
    const shading::Surface s = shading::surface_at(surfaces_, i);
    const float glass = shading::clamp01(s.transmission) * (1.0F - shading::clamp01(s.metallic));
    // Inside glass there is no environment to stand in for a reflection.
    const bool inside = glass > 0.0F && !s.front;
    const float roughness = surfaces_.lobe_roughness[i];
    const float mirror = inside ? 1.0F : mirror_share(roughness);
    const bool layered = (surfaces_.layered >> i & 1) != 0;
    const shading::Layers layers = layered ? surfaces_.layers[i] : shading::Layers{};
    const float coat = layers.coat > 0.0F ? mirror_share(layers.coat_roughness) : 0.0F;
    if (mirror == 0.0F && glass == 0.0F && coat == 0.0F) return 1.0F;
    const glm::vec3 view = group.view.get(i);
    const float cosine = shading::clamp01(glm::dot(s.normal, view));
    glm::vec3 reflectance =
        shading::fresnel(shading::lobes_at(surfaces_, i), cosine) * surfaces_.scale.get(i);
    Refraction refraction;
    if (glass > 0.0F) {
      refraction = refracted(view, s.normal, s.front ? 1.0F / s.ior : s.ior);
      reflectance += (glm::vec3(refraction.reflected * layers.below) - reflectance) * glass;
    }
    NextRay ray;
    ray.spread = context_.view.spread();
    ray.width = group.width[i] + group.packet.far[i] * group.spread[i];
    ray.pixel = lanes.pixel_of(i);
    ray.depth = depth_of(lanes, i) - 1;
    ray.branch = branch_of(lanes, i, Bundle::mirrored);
    const glm::vec3 throughput = lanes.throughput_of(i);
    float blurred = inside ? 0.0F : 1.0F;
    // One ray for surface and coat, whose normals hardly differ.
    const float by_coat = coat * layers.coat * shading::coat_fresnel(cosine);
    ray.throughput = throughput * (reflectance * mirror + glm::vec3(by_coat));
    if (brightest(ray.throughput) >= kLeastThroughput) {
      blurred = inside ? 0.0F : 1.0F - mirror;
      blurred_coat_[i] = inside ? 0.0F : 1.0F - coat;
      ray.origin = s.position + s.geometric_normal * group.offset[i];
      ray.direction = kept_on_side(mirrored(view, s.normal), s.geometric_normal);
      ray.view = -ray.direction;
      enqueue(ray, Bundle::mirrored);
    }
    if (glass > 0.0F && refraction.reflected < 1.0F) {
      ray.throughput =
          throughput * s.base_colour * (glass * (1.0F - refraction.reflected) * layers.below);
      if (brightest(ray.throughput) >= kLeastThroughput) {
        ray.branch = branch_of(lanes, i, Bundle::refracted);
        const bool thin = (surfaces_.thin >> i & 1) != 0;
        ray.origin = s.position - s.geometric_normal * group.offset[i];
        ray.direction = thin ? -view : kept_on_side(refraction.direction, -s.geometric_normal);
        ray.view = -ray.direction;
        enqueue(ray, Bundle::refracted);
      }
    }
    return blurred;
  }

  // Bodies of glass take from the light that comes out of them.
  void absorb(const RayGroup& group, RayLanes& lanes, LaneMask seen) {
    for (LaneMask rest = seen; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      const auto& material = context_.shader.material(group.material[i]);
      if (!material.absorbs || surfaces_.front[i] != 0) continue;
      if (!lanes.has_throughput) {
        for (int k = 0; k < kPacketRays; ++k) lanes.throughput.set(k, glm::vec3(1.0F));
        lanes.has_throughput = true;
      }
      const RayPacket& packet = group.packet;
      const float distance =
          glm::distance(surfaces_.position.get(i),
                        glm::vec3(packet.origin_x[i], packet.origin_y[i], packet.origin_z[i]));
      lanes.throughput.set(
          i, lanes.throughput.get(i) * shading::transmittance(material.material, distance));
    }
  }

  static float mirror_share(float roughness) {
    return shading::clamp01((kMatt - roughness) * (1.0F / (kMatt - kMirror)));
  }

  shading::Floats16 blurred_coat_;  // of the environment in the coat, what each lane shows
  shading::Surfaces surfaces_;
  shading::Vectors16 colour_;
};

}  // namespace

std::unique_ptr<WavefrontIntegrator> make_whitted(const FrameContext& context) {
  return std::make_unique<Whitted>(context);
}

}  // namespace delray::raytrace
