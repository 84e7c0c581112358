#include "raytrace/distribution.h"

#include <algorithm>

#include "raytrace/distributed/distributions.h"

namespace delray::raytrace {
namespace {

constexpr Distribution kDistributions[] = {
    {"replicated", "every rank has the whole scene", nullptr, true},
    {"object", "ranks fetch the parts of the scene that they need, and cache them (Badouel, Wald)",
     meet_by_object},
    {"ray",
     "rays go to the ranks that have the parts of the scene that they may hit (Caspary, Jevans)",
     meet_by_ray},
    {"ring", "rays go around all ranks; parts of the scene move to less loaded neighbours (Kim)",
     nullptr},
    {"hybrid", "rays or parts of the scene are sent, whichever the queues favour (Nebel)",
     meet_by_either},
};

}  // namespace

std::span<const Distribution> distributions() { return kDistributions; }

const Distribution* find_distribution(std::string_view name) {
  const auto* at = std::find_if(std::begin(kDistributions), std::end(kDistributions),
                                [&](const Distribution& d) { return d.name == name; });
  return at == std::end(kDistributions) ? nullptr : at;
}

}  // namespace delray::raytrace
