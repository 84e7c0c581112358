// Albedo, normals and numbers of the first surface, as pictures.
#include "raytrace/integrators/feature_integrators.h"

#include <bit>

#include "raytrace/integrators/direct_lighting.h"
#include "raytrace/integrators/lane_sums.h"
#include "raytrace/scene/embree_scene.h"

namespace delray::raytrace {
namespace {

using shading::LaneMask;

// Nothing comes from where no surface is.
FrameContext without_environment(const FrameContext& context) {
  FrameContext result = context;
  result.options.background = TraceOptions::Background::transparent;
  return result;
}

class SurfaceFeature final : public DirectLighting {
 public:
  SurfaceFeature(const FrameContext& context, shading::Vectors16 shading::Surfaces::*shown)
      : DirectLighting(without_environment(context)), shown_(shown) {}

 private:
  LaneMask shade_group(RayGroup& group, RayLanes& lanes, shading::Shaded& shown) override {
    const LaneMask seen = evaluate_hits(group, lanes, surfaces_);
    copy_lanes(surfaces_.*shown_, seen, shown.colour);
    if (shown_ == &shading::Surfaces::base_colour) {
      for (LaneMask rest = seen; rest != 0; rest &= rest - 1) {
        const int i = std::countr_zero(rest);
        const glm::vec3 emission = surfaces_.emission.get(i);
        if (emission == glm::vec3(0.0F)) continue;
        shown.colour.set(i, glm::min(shown.colour.get(i) + emission, glm::vec3(1.0F)));
      }
    }
    return seen;
  }

  shading::Vectors16 shading::Surfaces::*shown_;
  shading::Surfaces surfaces_;
};

class IdentityFeature final : public DirectLighting {
 public:
  explicit IdentityFeature(const FrameContext& context)
      : DirectLighting(without_environment(context)) {}

 private:
  LaneMask shade_group(RayGroup& group, RayLanes& lanes, shading::Shaded&) override {
    for (LaneMask rest = evaluate_hits(group, lanes, surfaces_); rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      const std::uint32_t pixel = lanes.pixel_of(i);
      SampleBlock& block = samples_[pixel / kPacketRays];
      const auto lane = static_cast<int>(pixel % kPacketRays);
      if (block.colour.x[lane] != 0.0F) continue;
      const Hit hit = hit_of(group.packet, i);
      block.colour.set(
          lane, {static_cast<float>(hit.instance + 1), static_cast<float>(group.material[i] + 1),
                 static_cast<float>(hit.triangle + 1)});
    }
    return 0;  // numbers are not weighted
  }

  shading::Surfaces surfaces_;
};

}  // namespace

std::unique_ptr<WavefrontIntegrator> make_albedo(const FrameContext& context) {
  return std::make_unique<SurfaceFeature>(context, &shading::Surfaces::base_colour);
}

std::unique_ptr<WavefrontIntegrator> make_normal(const FrameContext& context) {
  return std::make_unique<SurfaceFeature>(context, &shading::Surfaces::normal);
}

std::unique_ptr<WavefrontIntegrator> make_identity(const FrameContext& context) {
  return std::make_unique<IdentityFeature>(context);
}

}  // namespace delray::raytrace
