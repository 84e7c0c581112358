// Ambient occlusion.
#pragma once

#include <memory>

#include "raytrace/integrators/wavefront_integrator.h"

namespace delray::raytrace {

// White where nothing is within `reach` above a surface, black where all directions are covered,
// weighted with the cosine to the normal: one direction for each sample. Materials play no part,
// but for layers, which cover as much as they do elsewhere.
std::unique_ptr<WavefrontIntegrator> make_ao(const FrameContext& context);

}  // namespace delray::raytrace
