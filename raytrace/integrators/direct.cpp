// Sums emission, terms of the environment and lights with shadow rays for surfaces side by side;
// without shadows the shading of the whole block in one call.
#include "raytrace/integrators/direct.h"

#include <bit>

#include "raytrace/integrators/direct_lighting.h"
#include "raytrace/integrators/lane_sums.h"
#include "raytrace/scene/same_material.h"

namespace delray::raytrace {
namespace {

using shading::LaneMask;

class Direct final : public DirectLighting {
 public:
  using DirectLighting::DirectLighting;

 private:
  LaneMask shade_group(RayGroup& group, RayLanes& lanes, shading::Shaded& shown) override {
    if (!context_.options.shadows) return shade_unshadowed(group, lanes, shown);
    const LaneMask seen = evaluate_hits(group, lanes, surfaces_);
    if (seen == 0) return 0;
    const shading::BatchShader& shader = context_.shader;
    copy_lanes(surfaces_.emission, seen, shown.colour);
    shading::ambient_diffuse(shader, surfaces_, group.view, seen, colour_);
    add_lanes(colour_, seen, shown.colour);
    shading::ambient_specular(shader, surfaces_, group.view, seen, colour_);
    add_lanes(colour_, seen, shown.colour);
    if (const LaneMask layered = surfaces_.layered & seen; layered != 0) {
      shading::ambient_coat(shader, surfaces_, group.view, layered, colour_);
      add_lanes(colour_, layered, shown.colour);
    }
    shading::ambient_transmitted(shader, surfaces_, group.view, seen, colour_);
    add_lanes(colour_, seen, shown.colour);
    enqueue_lights(group, lanes, seen, surfaces_);
    return seen;
  }

  LaneMask shade_unshadowed(const RayGroup& group, RayLanes& lanes, shading::Shaded& shown) {
    for (LaneMask rest = group.hits; rest != 0;) {
      const LaneMask same = same_material(group, rest);
      shading::shade(context_.shader, group.material[std::countr_zero(rest)], group.points,
                     group.view, same, {}, shown);
      rest &= ~same;
    }
    return see(group, lanes, shown.alpha);
  }

  shading::Surfaces surfaces_;
  shading::Vectors16 colour_;
};

}  // namespace

std::unique_ptr<WavefrontIntegrator> make_direct(const FrameContext& context) {
  return std::make_unique<Direct>(context);
}

}  // namespace delray::raytrace
