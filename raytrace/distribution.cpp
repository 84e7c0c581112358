#include "raytrace/distribution.h"

#include <algorithm>

#include "raytrace/internal/distributions.h"

namespace delray::raytrace {
namespace {

constexpr Distribution kDistributions[] = {
    {"replicated", "every rank has the whole scene", nullptr, true},
    {"object", "clusters are fetched on demand and kept while there is room (Badouel, Wald)",
     meet_by_object},
    {"ray", "rays travel to the ranks that have what they may meet (Caspary, Jevans)", meet_by_ray},
    {"ring", "rays go round all ranks; clusters move to less loaded neighbours (Kim)", nullptr},
    {"hybrid", "rays or clusters, whichever the waiting lists favour (Nebel)", meet_by_either},
};

}  // namespace

std::span<const Distribution> distributions() { return kDistributions; }

const Distribution* find_distribution(std::string_view name) {
  const auto* at = std::find_if(std::begin(kDistributions), std::end(kDistributions),
                                [&](const Distribution& d) { return d.name == name; });
  return at == std::end(kDistributions) ? nullptr : at;
}

}  // namespace delray::raytrace
