// Base class of the integrators that follow no random paths: layers that can be seen through,
// misses, and lights with their shadow rays.
#pragma once

#include <cstdint>

#include "raytrace/integrators/wavefront_integrator.h"
#include "shading/batch.h"

namespace delray::raytrace {

// A ray that could change its sample by less than this is not sent.
inline constexpr float kLeastThroughput = 1.0F / 256.0F;

// Rays of neighbouring pixels that were sent for one reason are alike, and share groups.
enum class Bundle : std::uint8_t { straight, mirrored, refracted };
inline constexpr int kBundles = 3;

// State of the rays of a group beside their geometry.
struct RayLanes {
  bool whole = true;        // the primary rays of `block`: of the rest only `throughput` is set
  std::uint32_t block = 0;  // of samples()
  Bundle bundle = Bundle::straight;
  bool has_throughput = false;    // whether `throughput` is set; 1 if not
  shading::Vectors16 throughput;  // of the path: what the sample makes of radiance along the ray
  alignas(64) std::uint32_t pixel[kPacketRays];   // 16 * block + lane in it
  alignas(64) std::int32_t depth[kPacketRays];    // how often it may be mirrored or refracted
  alignas(64) std::uint32_t branch[kPacketRays];  // of the sample's tree of rays; 0: its root
  alignas(64) std::uint32_t layers[kPacketRays];  // passed before
  alignas(64) std::uint32_t instance[kPacketRays], triangle[kPacketRays];  // of the last layer

  std::uint32_t pixel_of(int i) const {
    return whole ? block * kPacketRays + static_cast<std::uint32_t>(i) : pixel[i];
  }
  glm::vec3 throughput_of(int i) const {
    return has_throughput ? throughput.get(i) : glm::vec3(1.0F);
  }
  template <class Visitor>
  void visit(Visitor& to) {  // waiting_rays.h
    to.value(whole);
    to.value(block);
    to.value(bundle);
    to.value(has_throughput);
    if (has_throughput) {
      for (float* const field : {throughput.x.lane, throughput.y.lane, throughput.z.lane})
        to.lanes(field);
    }
    if (whole) return;
    to.lanes(depth);
    for (std::uint32_t* const field : {pixel, branch, layers, instance, triangle}) to.lanes(field);
  }
};

// A ray to be put into a group. `direction` may have any length, `view` is the unit vector back.
struct NextRay {
  glm::vec3 origin{0.0F}, direction{0.0F}, view{0.0F};
  float near = 0.0F, width = 0.0F, spread = 0.0F;
  glm::vec3 throughput{1.0F};
  std::uint32_t pixel = 0;
  std::int32_t depth = 0;
  std::uint32_t branch = 0;
  std::uint32_t layers = 0, instance = kMiss, triangle = kMiss;
};

// Parts of the lanes' specular lobes, from 0 to 1, that rays along the mirror direction stand for.
struct Mirrored {
  shading::Floats16 base{}, coat{};
};

class DirectLighting : public WavefrontIntegrator {
 public:
  explicit DirectLighting(const FrameContext& context, Positions positions = Positions::regular)
      : WavefrontIntegrator(context, positions) {}

 protected:
  // Writes what the surfaces that a group's rays met show to their lanes of `shown`, and asks for
  // more. Returns those lanes. REQUIRES: group.hits != 0.
  virtual shading::LaneMask shade_group(RayGroup& group, RayLanes& lanes,
                                        shading::Shaded& shown) = 0;

  // Sets `surfaces` of a group's hits, and does what see() does.
  shading::LaneMask evaluate_hits(const RayGroup& group, RayLanes& lanes,
                                  shading::Surfaces& surfaces);

  // Given Surface::alpha of the hits: asks for rays behind layers, multiplies throughputs by alpha,
  // notes depths. Returns the lanes that show anything.
  shading::LaneMask see(const RayGroup& group, RayLanes& lanes, const shading::Floats16& alpha);

  // Asks for shadow rays to every light that matters, groups of rays for each: to points drawn from
  // what has a size, lights and emissive surfaces. What mirrored rays meet does not count twice.
  void enqueue_lights(const RayGroup& group, const RayLanes& lanes, shading::LaneMask mask,
                      const shading::Surfaces& surfaces, const Mirrored& mirrored = {});

  // The same for directions of the lanes' own, unit vectors, of which `reflected` will be added
  // where nothing is within a distance. `coherent`: they are like those of neighbours.
  void enqueue_shadows(const RayGroup& group, const RayLanes& lanes, shading::LaneMask mask,
                       const shading::Surfaces& surfaces, const shading::Vectors16& directions,
                       const shading::Floats16& distances, const shading::Vectors16& reflected,
                       bool coherent);

  void enqueue(const NextRay& ray, Bundle bundle);

  std::int32_t depth_of(const RayLanes& lanes, int i) const {
    return lanes.whole ? context_.options.depth : lanes.depth[i];
  }

  // Of a ray that a lane's hit sends. Numbers wrap around, in very deep trees.
  static std::uint32_t branch_of(const RayLanes& lanes, int i, Bundle bundle) {
    const std::uint32_t own = lanes.whole ? 0 : lanes.branch[i];
    return own * kBundles + static_cast<std::uint32_t>(bundle) + 1;
  }

 private:
  // A group of shadow rays, which add to samples what arrives of the light.
  struct Light {
    std::size_t source = 0;  // the group whose hits they start from
    bool whole = true;
    std::uint32_t block = 0;
    alignas(64) std::uint32_t pixel[kPacketRays];
    shading::Vectors16 reflected;

    std::uint32_t pixel_of(int i) const {
      return whole ? block * kPacketRays + static_cast<std::uint32_t>(i) : pixel[i];
    }
    template <class Visitor>
    void visit(Visitor& to) {
      to.value(source);
      to.value(whole);
      to.value(block);
      for (float* const field : {reflected.x.lane, reflected.y.lane, reflected.z.lane})
        to.lanes(field);
      if (!whole) to.value(pixel);  // of all lanes: those of the source's other groups look here
    }
  };

  void begin() final;
  void shade() final;
  void count_waiting(std::span<std::uint32_t> by_block) final;
  RayCounts write_waiting(std::span<const std::uint8_t> moved, RayWriter& to) final;
  void read_waiting(RayReader& from) final;
  void add_lights();
  void add(const RayLanes& lanes, shading::LaneMask mask, const shading::Vectors16& radiance);
  shading::LaneMask show_environment(const RayGroup& group, const RayLanes& lanes);
  shading::LaneMask enqueue_behind_layers(const RayGroup& group, RayLanes& lanes,
                                          shading::LaneMask layered,
                                          const shading::Floats16& alpha);
  void enqueue_behind(const RayGroup& group, const RayLanes& lanes, int i,
                      const glm::vec3& throughput);
  // A light as it acts from its place or, of an area light, from its centre.
  void enqueue_light(const RayGroup& group, const RayLanes& lanes, shading::LaneMask mask,
                     std::size_t light, const shading::Surfaces& surfaces);

  // Lights with a size (sampled_lights.cpp).
  void enqueue_sized_lights(const RayGroup& group, const RayLanes& lanes, shading::LaneMask mask,
                            const shading::Surfaces& surfaces, const Mirrored& mirrored);
  // Of the surfaces' lobes those that samples of lights find, and the others. Returns the lanes
  // that have others.
  static shading::LaneMask split_lobes(const shading::Surfaces& surfaces, shading::LaneMask mask,
                                       const Mirrored& mirrored, shading::Surfaces& wide,
                                       shading::Surfaces& narrow);
  int points_per_light() const;  // that each surface draws
  // Numbers for one of them; what glows counts as the light after the last.
  void draw_points(const RayLanes& lanes, shading::LaneMask mask, std::size_t light, int point,
                   std::span<Pairs16> pairs);
  void enqueue_points(const RayGroup& group, const RayLanes& lanes, shading::LaneMask mask,
                      const shading::Surfaces& surfaces, LightSamples& points);
  void enqueue_area_light(const RayGroup& group, const RayLanes& lanes, shading::LaneMask mask,
                          std::size_t light);
  void enqueue_emission(const RayGroup& group, const RayLanes& lanes, shading::LaneMask mask);

  Groups<RayLanes> enqueued_, intersected_;  // of next_.rays and batch_.rays
  Groups<Light> enqueued_lights_, intersected_lights_;
  shading::Vectors16 directions_, sum_;
  shading::Shaded shown_;
  shading::Arriving arriving_;
  shading::Surfaces wide_, narrow_;
  shading::Vectors16 reflected_;
  LightSamples points_;
  std::size_t source_ = 0;  // the group that is looked at
  // The group of next_.rays that each bundle fills, and how many of its lanes are in use.
  struct Open {
    std::size_t group = 0;
    int used = kPacketRays;
  };
  Open open_[kBundles];
};

}  // namespace delray::raytrace
