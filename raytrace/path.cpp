#include "raytrace/path.h"

#include <bit>
#include <utility>

#include "image/image.h"
#include "raytrace/bsdf.h"
#include "raytrace/internal/ask.h"
#include "raytrace/internal/lane_sums.h"
#include "raytrace/internal/same_material.h"
#include "raytrace/light_table.h"
#include "shading/batch.h"

namespace delray::raytrace {
namespace {

using shading::LaneMask;

// Scatterings after which a path may end by chance.
constexpr int kCertain = 2;

// What is drawn at each surface: dimensions of the sampler.
enum Dimension : std::uint32_t {
  kLayer,
  kLight,
  kLobe = kLight + LightTable::kDimensions,
  kDirection,
  kGoOn,
  kDimensions,
};

// What a path tracer knows of the rays of a group besides.
struct PathLanes {
  bool whole = true;          // the primary rays of `block`: the rest is not set
  std::uint32_t block = 0;    // of samples()
  shading::Vectors16 weight;  // what the sample makes of radiance along the ray
  shading::Floats16 pdf;      // with which the direction was drawn; 0: no other way finds it
  alignas(64) std::uint32_t pixel[kPacketRays];   // 16 * sample block + lane in it
  alignas(64) std::uint32_t bounce[kPacketRays];  // scatterings so far
  alignas(64) std::uint32_t vertex[kPacketRays];  // surfaces met so far, layers among them
  alignas(64) std::uint32_t placement[kPacketRays], triangle[kPacketRays];  // left behind
};

struct LightLanes {
  shading::Vectors16 reflected;  // what is added if all of the light arrives
  alignas(64) std::uint32_t pixel[kPacketRays];
};

bool finite(const glm::vec3& v) {
  return brightest(glm::abs(v)) < std::numeric_limits<float>::infinity();  // false for NaN
}

class Path final : public Walk {
 public:
  explicit Path(const Setting& setting) : Walk(setting, Positions::random) {}

 private:
  void begin() override {
    asked_.clear();
    asked_lights_.clear();
    used_ = used_lights_ = kPacketRays;
    for (std::uint32_t block = 0; block < next_.rays.size(); ++block) {
      PathLanes& lanes = asked_.add();
      lanes.whole = true;
      lanes.block = block;
    }
  }

  void look() override {
    std::swap(asked_, answered_);
    std::swap(asked_lights_, answered_lights_);
    asked_.clear();
    asked_lights_.clear();
    used_ = used_lights_ = kPacketRays;
    for (std::size_t g = 0; g < wave_.shadows.size(); ++g) {
      add_light(wave_.shadows[g], answered_lights_[g]);
    }
    for (std::size_t g = 0; g < wave_.rays.size(); ++g) {
      PathLanes& lanes = answered_[g];
      if (lanes.whole && wave_.rays[g].hits != 0) spell_out(lanes);
      add_sky(wave_.rays[g], lanes);
      if (wave_.rays[g].hits != 0) look_at(wave_.rays[g], lanes);
    }
  }

  static void spell_out(PathLanes& lanes) {
    for (int i = 0; i < kPacketRays; ++i) {
      lanes.weight.set(i, glm::vec3(1.0F));
      lanes.pdf[i] = 0.0F;
      lanes.pixel[i] = lanes.block * kPacketRays + static_cast<std::uint32_t>(i);
      lanes.bounce[i] = lanes.vertex[i] = 0;
      lanes.placement[i] = lanes.triangle[i] = kMiss;
    }
  }

  void add(std::uint32_t pixel, const glm::vec3& radiance) {
    if (!finite(radiance)) return;
    SampleBlock& block = samples_[pixel / kPacketRays];
    const int lane = static_cast<int>(pixel % kPacketRays);
    block.colour.set(lane, block.colour.get(lane) + radiance);
  }

  void add_light(const ShadowGroup& group, const LightLanes& lanes) {
    for (LaneMask rest = group.lit; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      const glm::vec3 reflected = lanes.reflected.get(i);
      add(lanes.pixel[i], (group.dimmed >> i & 1) != 0 ? reflected * group.left.get(i) : reflected);
    }
  }

  void add_sky(const RayGroup& group, const PathLanes& lanes) {
    LaneMask missed = active_lanes(group.active) & ~group.hits;
    if (missed == 0) return;
    const bool transparent = setting_.options.background == TraceOptions::Background::transparent;
    if (lanes.whole && transparent) {
      SampleBlock& block = samples_[lanes.block];
      choose_lanes(block.alpha.lane, 0.0F, ~missed, block.alpha);
      return;
    }
    if (transparent) {
      for (LaneMask rest = missed; rest != 0; rest &= rest - 1) {
        const int i = std::countr_zero(rest);
        if (lanes.bounce[i] != 0) continue;
        samples_[lanes.pixel[i] / kPacketRays]
            .alpha[static_cast<int>(lanes.pixel[i] % kPacketRays)] = 0.0F;
        missed &= ~(1U << i);
      }
    }
    if (missed == 0 || setting_.shader.shader->environment.black) return;
    negate_lanes(group.view, directions_);
    shading::environment_radiance(setting_.shader, directions_, 0.0F, missed, colour_);
    if (lanes.whole) return add_lanes(colour_, missed, samples_[lanes.block].colour);
    for (LaneMask rest = missed; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      float share = 1.0F;
      if (lanes.pdf[i] > 0.0F) {
        share = power_heuristic(lanes.pdf[i], setting_.lights.pdf_of_sky(directions_.get(i)));
      }
      add(lanes.pixel[i], lanes.weight.get(i) * colour_.get(i) * share);
    }
  }

  void look_at(const RayGroup& group, const PathLanes& lanes) {
    for (LaneMask rest = group.hits; rest != 0;) {
      const LaneMask same = same_material(group, rest);
      shading::evaluate(setting_.shader, group.material[std::countr_zero(rest)], group.points,
                        group.view, same, surfaces_);
      rest &= ~same;
    }
    for (LaneMask rest = group.hits; rest != 0; rest &= rest - 1) {
      meet(group, lanes, std::countr_zero(rest));
    }
  }

  // One surface on the way of a path.
  void meet(const RayGroup& group, const PathLanes& lanes, int i) {
    const std::uint32_t pixel = lanes.pixel[i];
    const Sampler numbers = sampler(pixel);
    const auto dimension = [&](Dimension which) {
      Sampler result = numbers;
      result.skip(lanes.vertex[i] * kDimensions + which);
      return result;
    };
    const Hit hit = hit_of(group.packet, i);
    const float alpha = surfaces_.alpha[i];
    if (alpha < 1.0F ||
        (hit.placement == lanes.placement[i] && hit.triangle == lanes.triangle[i])) {
      const bool again = hit.placement == lanes.placement[i] && hit.triangle == lanes.triangle[i];
      if (again || !(dimension(kLayer).one() < alpha)) return go_behind(group, lanes, i, hit);
    }
    if (lanes.bounce[i] == 0) {
      samples_[pixel / kPacketRays].depth[static_cast<int>(pixel % kPacketRays)] = hit.distance;
    }
    const glm::vec3 weight = lanes.weight.get(i);
    const shading::Surface surface = shading::surface_at(surfaces_, i);
    if (surface.emission != glm::vec3(0.0F)) {
      float share = 1.0F;
      if (lanes.pdf[i] > 0.0F) {
        share = power_heuristic(
            lanes.pdf[i], setting_.lights.pdf_of_hit(hit.placement, hit.triangle,
                                                     origin_of(group.packet, i), surface.position));
      }
      add(pixel, weight * surface.emission * share);
    }
    if (static_cast<int>(lanes.bounce[i]) >= setting_.options.depth) return;
    const Bsdf bsdf = make_bsdf(surface, group.view.get(i));
    if (bsdf.black) return;
    const glm::vec3 offset = surface.geometric_normal * group.offset[i];
    Sampler light_numbers = dimension(kLight);
    const LightSample light =
        setting_.lights.sample(*setting_.shader.shader, surface.position, light_numbers);
    if (brightest(light.weight) > 0.0F) {
      const BsdfValue value = evaluate(bsdf, light.direction);
      const float share = light.pdf > 0.0F ? power_heuristic(light.pdf, value.pdf) : 1.0F;
      const glm::vec3 reflected = weight * value.value * light.weight * share;
      if (brightest(reflected) > 0.0F) {
        const bool above = glm::dot(light.direction, surface.geometric_normal) >= 0.0F;
        ask_light(above ? surface.position + offset : surface.position - offset, light, reflected,
                  pixel);
      }
    }
    const BsdfSample scattered = sample(bsdf, dimension(kLobe).one(), dimension(kDirection).two());
    glm::vec3 next = weight * scattered.weight;
    if (!(brightest(next) > 0.0F) || !finite(next)) return;
    if (lanes.bounce[i] >= kCertain) {
      const float chance = std::min(brightest(next), 1.0F);
      if (!(dimension(kGoOn).one() < chance)) return;
      next *= 1.0F / chance;
    }
    const glm::vec3 origin =
        scattered.transmitted ? surface.position - offset : surface.position + offset;
    const auto [to, lane] = lane_for_ray();
    set_ray(next_.rays.back(), lane, origin, scattered.direction, -scattered.direction, 0.0F);
    next_.rays.back().width[lane] = group.width[i] + group.packet.far[i] * group.spread[i];
    next_.rays.back().spread[lane] = spread_after(group.spread[i], scattered.pdf);
    to->weight.set(lane, next);
    to->pdf[lane] = scattered.delta ? 0.0F : scattered.pdf;
    to->pixel[lane] = pixel;
    to->bounce[lane] = lanes.bounce[i] + 1;
    to->vertex[lane] = lanes.vertex[i] + 1;
    to->placement[lane] = to->triangle[lane] = kMiss;
    ++rays_.secondary;
  }

  // A cone of the directions that are drawn with about the density of this one, as a ratio of width
  // and distance; wide enough for textures to be read from small levels, never all of the sphere.
  static float spread_after(float spread, float pdf) {
    constexpr float kWidest = 0.25F;
    if (!(pdf > 0.0F)) return spread;
    return std::max(spread, std::min(kWidest, 0.25F / std::sqrt(pdf)));
  }

  void go_behind(const RayGroup& group, const PathLanes& lanes, int i, const Hit& hit) {
    if (lanes.vertex[i] >= kMostLayers + static_cast<std::uint32_t>(setting_.options.depth)) return;
    const auto [to, lane] = lane_for_ray();
    set_ray(next_.rays.back(), lane, origin_of(group.packet, i), direction_of(group.packet, i),
            group.view.get(i), next_up(hit.distance));
    next_.rays.back().width[lane] = group.width[i];
    next_.rays.back().spread[lane] = group.spread[i];
    to->weight.set(lane, lanes.weight.get(i));
    to->pdf[lane] = lanes.pdf[i];
    to->pixel[lane] = lanes.pixel[i];
    to->bounce[lane] = lanes.bounce[i];
    to->vertex[lane] = lanes.vertex[i] + 1;
    to->placement[lane] = hit.placement;
    to->triangle[lane] = hit.triangle;
    ++(lanes.bounce[i] == 0 ? rays_.primary : rays_.secondary);
  }

  std::pair<PathLanes*, int> lane_for_ray() {
    if (used_ == kPacketRays) {
      clear_lanes(next_.rays.add());
      asked_.add().whole = false;
      used_ = 0;
    }
    return {&asked_.back(), used_++};
  }

  void ask_light(const glm::vec3& origin, const LightSample& light, const glm::vec3& reflected,
                 std::uint32_t pixel) {
    if (used_lights_ == kPacketRays) {
      ShadowGroup& fresh = next_.shadows.add();
      clear_lanes(fresh);
      fresh.through_glass = 0;
      asked_lights_.add();
      used_lights_ = 0;
    }
    const int lane = used_lights_++;
    ShadowGroup& group = next_.shadows.back();
    set_shadow_ray(group, lane, origin, light.direction, light.distance * kShadowReach);
    if (!(light.pdf > 0.0F)) group.through_glass |= 1U << lane;
    asked_lights_.back().reflected.set(lane, reflected);
    asked_lights_.back().pixel[lane] = pixel;
    ++rays_.shadow;
  }

  Groups<PathLanes> asked_, answered_;  // of next_.rays and wave_.rays
  Groups<LightLanes> asked_lights_, answered_lights_;
  int used_ = kPacketRays, used_lights_ = kPacketRays;  // lanes of the last groups of next_
  shading::Surfaces surfaces_;
  shading::Vectors16 directions_, colour_;
};

}  // namespace

std::unique_ptr<Walk> make_path(const Setting& setting) { return std::make_unique<Path>(setting); }

}  // namespace delray::raytrace
