#include "raytrace/integrator.h"

#include <stdexcept>
#include <string>

#include "raytrace/direct.h"
#include "raytrace/whitted.h"

namespace delray::raytrace {
namespace {

constexpr Integrator kIntegrators[] = {
    {"direct", "lights with their shadows, and the environment", make_direct},
    {"whitted", "shadows, mirror reflection and refraction (Whitted 1980)", make_whitted},
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
