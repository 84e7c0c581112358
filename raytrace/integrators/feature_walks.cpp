#include "raytrace/integrators/feature_walks.h"

#include <bit>

#include "raytrace/integrators/lane_sums.h"
#include "raytrace/integrators/lit_walk.h"
#include "raytrace/scene/embree_scene.h"

namespace delray::raytrace {
namespace {

using shading::LaneMask;

// Nothing comes from where no surface is.
Setting without_environment(const Setting& setting) {
  Setting result = setting;
  result.options.background = TraceOptions::Background::transparent;
  return result;
}

class SurfaceWalk final : public LitWalk {
 public:
  SurfaceWalk(const Setting& setting, shading::Vectors16 shading::Surfaces::*shown)
      : LitWalk(without_environment(setting)), shown_(shown) {}

 private:
  LaneMask shade(RayGroup& group, RayLanes& lanes, shading::Shaded& shown) override {
    const LaneMask seen = look_at(group, lanes, surfaces_);
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

class IdentityWalk final : public LitWalk {
 public:
  explicit IdentityWalk(const Setting& setting) : LitWalk(without_environment(setting)) {}

 private:
  LaneMask shade(RayGroup& group, RayLanes& lanes, shading::Shaded&) override {
    for (LaneMask rest = look_at(group, lanes, surfaces_); rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      const std::uint32_t pixel = lanes.pixel_of(i);
      SampleBlock& block = samples_[pixel / kPacketRays];
      const auto lane = static_cast<int>(pixel % kPacketRays);
      if (block.colour.x[lane] != 0.0F) continue;
      const Hit hit = hit_of(group.packet, i);
      block.colour.set(
          lane, {static_cast<float>(hit.placement + 1), static_cast<float>(group.material[i] + 1),
                 static_cast<float>(hit.triangle + 1)});
    }
    return 0;  // numbers are not weighted
  }

  shading::Surfaces surfaces_;
};

}  // namespace

std::unique_ptr<Walk> make_albedo(const Setting& setting) {
  return std::make_unique<SurfaceWalk>(setting, &shading::Surfaces::base_colour);
}

std::unique_ptr<Walk> make_normal(const Setting& setting) {
  return std::make_unique<SurfaceWalk>(setting, &shading::Surfaces::normal);
}

std::unique_ptr<Walk> make_identity(const Setting& setting) {
  return std::make_unique<IdentityWalk>(setting);
}

}  // namespace delray::raytrace
