// How light along the rays of a pixel is computed: the table of integrators.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "raytrace/integrators/wavefront_integrator.h"

namespace delray::raytrace {

// An entry of the table of integrators.
struct Integrator {
  const char* name;
  const char* description;
  std::unique_ptr<WavefrontIntegrator> (*make)(const FrameContext& context);
  // Pixels of this rank's scene are walked through in squares of this side, a multiple of
  // kTaskSide, where tiles allow.
  int side = kTaskSide;
  bool lit = true;  // what it shows depends on light
  // Which of TraceOptions it looks at besides depth and seed:
  bool reaches = false;           // reach
  bool may_omit_shadows = false;  // shadows
  bool scatters = false;          // diffuse_depth
  // A pixel's samples are the same however many there are, but for a single one; else they lie on a
  // grid of all of them unless Setting::scattered.
  bool any_samples = false;
};

std::span<const Integrator> integrators();

// Throws std::invalid_argument naming the legal ones.
const Integrator& integrator(std::string_view name);

}  // namespace delray::raytrace
