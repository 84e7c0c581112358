// The table of integrators, with which options each looks at.
#include "raytrace/integrator.h"

#include <stdexcept>
#include <string>

#include "raytrace/integrators/ao.h"
#include "raytrace/integrators/direct.h"
#include "raytrace/integrators/feature_integrators.h"
#include "raytrace/integrators/path.h"
#include "raytrace/integrators/whitted.h"

namespace delray::raytrace {
namespace {

constexpr Integrator kIntegrators[] = {
    {.name = "albedo",
     .description = "base colours, without light",
     .make = make_albedo,
     .lit = false},
    {.name = "ao",
     .description = "ambient occlusion: how much of the sky each surface sees",
     .make = make_ao,
     .lit = false,
     .reaches = true,
     .any_samples = true},
    {.name = "direct",
     .description = "light of light sources and of the environment, with shadows",
     .make = make_direct,
     .may_omit_shadows = true},
    {.name = "identity",
     .description = "numbers of instances, materials and triangles, from 1 on",
     .make = make_identity,
     .lit = false},
    {.name = "normal",
     .description = "shading normals: x, y, z as red, green, blue",
     .make = make_normal,
     .lit = false},
    {.name = "path",
     .description = "path tracing: light on all ways, by random sampling (Kajiya 1986)",
     .make = make_path,
     .side = 2 * kTaskSide,
     .scatters = true,
     .any_samples = true},
    {.name = "whitted",
     .description = "shadows, mirror reflections and refractions (Whitted 1980)",
     .make = make_whitted},
};

}  // namespace

std::span<const Integrator> integrators() { return kIntegrators; }

const Integrator& integrator(std::string_view name) {
  std::string names;
  for (const Integrator& candidate : kIntegrators) {
    if (candidate.name == name) return candidate;
    names += std::string(names.empty() ? "" : ", ") + candidate.name;
  }
  throw std::invalid_argument("unknown integrator '" + std::string(name) +
                              "'; there are: " + names);
}

}  // namespace delray::raytrace
