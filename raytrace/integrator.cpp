#include "raytrace/integrator.h"

#include <stdexcept>
#include <string>

#include "raytrace/integrators/ao.h"
#include "raytrace/integrators/direct.h"
#include "raytrace/integrators/feature_walks.h"
#include "raytrace/integrators/path.h"
#include "raytrace/integrators/whitted.h"

namespace delray::raytrace {
namespace {

constexpr Integrator kIntegrators[] = {
    {"albedo", "base colours, without light", make_albedo, kTaskSide, false},
    {"ao", "ambient occlusion: how much of the sky each surface sees", make_ao, kTaskSide, false},
    {"direct", "light of light sources and of the environment, with shadows", make_direct},
    {"identity", "numbers of instances, materials and triangles, from 1 on", make_identity,
     kTaskSide, false},
    {"normal", "shading normals: x, y, z as red, green, blue", make_normal, kTaskSide, false},
    {"path", "path tracing: light on all ways, by random sampling (Kajiya 1986)", make_path,
     2 * kTaskSide},
    {"whitted", "shadows, mirror reflections and refractions (Whitted 1980)", make_whitted},
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
