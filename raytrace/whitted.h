// Recursive ray tracing (Whitted 1980), section 3.2 of Kohout's report.
#pragma once

#include "raytrace/integrator.h"

namespace delray::raytrace {

// Primary rays and their shadow rays go in packets of a block, all others one by one.
//
// A surface shows its emission, the environment that it reflects diffusely, the light of each light
// that a shadow ray reaches (through glass and cut-outs attenuated, unbent), and what rays along
// the mirror and refraction directions see, weighted with Fresnel's terms. Rough surfaces mirror a
// blur of the environment instead, with a gradual change between; so do those that `depth` or the
// weight leaves no ray for. Radiance is summed in the order of this paragraph.
void trace_whitted(const Tracer& tracer, const scenes::View& view, const TraceOptions& options,
                   const Block& block, BlockResult& result, RayCounts& counts);

}  // namespace delray::raytrace
