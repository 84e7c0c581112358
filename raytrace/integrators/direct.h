// Direct light alone.
#pragma once

#include <memory>

#include "raytrace/integrators/wavefront_integrator.h"

namespace delray::raytrace {

// A surface shows its emission, the light of each light, and of what glows, that a shadow ray
// reaches, and, of what stands around it, the environment only: what the rasterizer shows of it,
// but for the shadows and lights with a size; without `shadows` the very same. Rays go on behind
// layers that can be seen through.
std::unique_ptr<WavefrontIntegrator> make_direct(const FrameContext& context);

}  // namespace delray::raytrace
