// Recursive ray tracing (Whitted 1980), section 3.2 of Kohout's report.
#pragma once

#include <memory>

#include "raytrace/integrators/wavefront_integrator.h"

namespace delray::raytrace {

// A surface shows its emission, the environment that it reflects diffusely, the light of each
// light, and of what glows, that a shadow ray reaches (through glass and cut-outs attenuated,
// unbent), and what rays along the mirror and refraction directions see, weighted with Fresnel's
// terms. Rough surfaces mirror a blur of the environment instead, with a gradual change between; so
// do those that `depth` or the weight leaves no ray for. A sample sums generation by generation:
// first the lights of the generation before, then what the surfaces that the rays have met show by
// themselves.
std::unique_ptr<WavefrontIntegrator> make_whitted(const FrameContext& context);

}  // namespace delray::raytrace
