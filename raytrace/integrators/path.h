// Light on all ways: path tracing (Kajiya 1986).
#pragma once

#include <memory>

#include "raytrace/integrators/wavefront_integrator.h"

namespace delray::raytrace {

// From every surface that a path meets one ray goes to a light and one into a direction that the
// surface scatters into; what both would find is weighted (multiple importance sampling, Veach
// 1997). Paths scatter diffusely at
// most `diffuse_depth` and otherwise at most `depth` times; from the third scattering on they end
// by chance when little would come of them, and count for more when they do not (Russian roulette).
// Glass takes from light what its volume absorbs on the way through. Layers are met or
// passed by chance. Through glass no light reaches a surface straight, except from lights of no
// size, which no scattered ray would ever find.
std::unique_ptr<WavefrontIntegrator> make_path(const FrameContext& context);

}  // namespace delray::raytrace
