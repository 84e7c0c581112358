// One shadow ray a sample in a direction drawn by the cosine to the normal; white where it meets
// nothing within reach. Degenerate: directions below the geometric surface count as dark, whatever
// their rays meet.
#include "raytrace/integrators/ao.h"

#include <bit>

#include "raytrace/integrators/direct_lighting.h"
#include "raytrace/integrators/enqueue.h"
#include "raytrace/sampling/sampler.h"
#include "raytrace/sampling/warp.h"

namespace delray::raytrace {
namespace {

using shading::LaneMask;

class AmbientOcclusion final : public DirectLighting {
 public:
  explicit AmbientOcclusion(const FrameContext& context)
      : DirectLighting(context, Positions::random) {
    for (float& reach : reach_.lane) reach = context.options.reach;
  }

 private:
  LaneMask shade_group(RayGroup& group, RayLanes& lanes, shading::Shaded& /*shown*/) override {
    const LaneMask seen = evaluate_hits(group, lanes, surfaces_);
    if (seen == 0) return 0;
    for (LaneMask rest = seen; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      Sampler numbers = sampler(lanes.pixel_of(i));
      numbers.skip(lanes.whole ? 0 : lanes.layers[i]);
      const glm::vec3 normal = surfaces_.normal.get(i);
      const glm::vec3 up = surfaces_.geometric_normal.get(i);
      const glm::vec3 direction = Frame(normal).to_world(cosine_direction(numbers.two()));
      directions_.set(i, direction);
      // Below the surface itself all is dark.
      white_.set(i, glm::vec3(glm::dot(direction, up) > 0.0F ? 1.0F : 0.0F));
    }
    enqueue_shadows(group, lanes, seen, surfaces_, directions_, reach_, white_, false);
    return 0;
  }

  shading::Surfaces surfaces_;
  shading::Vectors16 directions_, white_;
  shading::Floats16 reach_;
};

}  // namespace

std::unique_ptr<WavefrontIntegrator> make_ao(const FrameContext& context) {
  return std::make_unique<AmbientOcclusion>(context);
}

}  // namespace delray::raytrace
