// What surfaces are, instead of what light they send: pictures for denoising, for compositing
// afterwards, and to look at.
#pragma once

#include <memory>

#include "raytrace/integrators/wavefront_integrator.h"

namespace delray::raytrace {

// Of what primary rays see, without any light: base colours, brighter up to 1 by what glows (as
// denoisers like to have it), and unit normals of the shading, to the viewer's side (x, y, z as
// red, green, blue); both by alpha where there are layers.
std::unique_ptr<WavefrontIntegrator> make_albedo(const FrameContext& context);
std::unique_ptr<WavefrontIntegrator> make_normal(const FrameContext& context);

// Of the first thing that each primary ray sees, as numbers from 1 on: instance, material and
// triangle in red, green and blue; exact up to 2^24.
std::unique_ptr<WavefrontIntegrator> make_identity(const FrameContext& context);

}  // namespace delray::raytrace
