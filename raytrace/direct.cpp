#include "raytrace/direct.h"

#include <bit>

#include "raytrace/internal/lit_walk.h"
#include "raytrace/internal/same_material.h"

namespace delray::raytrace {
namespace {

using shading::LaneMask;

class Direct final : public LitWalk {
 public:
  using LitWalk::LitWalk;

 private:
  void shade(RayGroup& group, RayLanes& lanes) override {
    if (!setting_.options.shadows) return shade_unshadowed(group, lanes);
    const LaneMask seen = look_at(group, lanes, surfaces_);
    if (seen == 0) return;
    const shading::BatchShader& shader = setting_.shader;
    shading::Vectors16& colour = shaded_.colour;
    add(lanes, seen, surfaces_.emission);
    shading::ambient_diffuse(shader, surfaces_, group.view, seen, colour);
    add(lanes, seen, colour);
    shading::ambient_specular(shader, surfaces_, group.view, seen, colour);
    add(lanes, seen, colour);
    shading::ambient_transmitted(shader, surfaces_, group.view, seen, colour);
    add(lanes, seen, colour);
    ask_lights(group, lanes, seen, surfaces_);
  }

  void shade_unshadowed(RayGroup& group, RayLanes& lanes) {
    for (LaneMask rest = group.hits; rest != 0;) {
      const LaneMask same = same_material(group, rest);
      shading::shade(setting_.shader, group.material[std::countr_zero(rest)], group.points,
                     group.view, same, {}, shaded_);
      rest &= ~same;
    }
    const LaneMask seen = see(group, lanes, shaded_.alpha);
    if (seen != 0) add(lanes, seen, shaded_.colour);
  }

  shading::Surfaces surfaces_;
  shading::Shaded shaded_;
};

}  // namespace

std::unique_ptr<Walk> make_direct(const Setting& setting) {
  return std::make_unique<Direct>(setting);
}

}  // namespace delray::raytrace
