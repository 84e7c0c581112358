// The table of distributions of a scene over ranks: how rays and geometry meet.
#include "raytrace/distribution.h"

#include "files/find_named.h"
#include "raytrace/distributed/distributions.h"

namespace delray::raytrace {
namespace {

constexpr Distribution kDistributions[] = {
    {.name = "replicated",
     .description = "every rank has the whole scene",
     .decide = nullptr,
     .replicated = true},
    {.name = "object",
     .description =
         "ranks fetch the parts of the scene that they need, and cache them (Badouel, Wald)",
     .decide = distribute_object,
     .fetches = true,
     .plans_tiles = true},
    {.name = "ray",
     .description = "rays go to the ranks that have the parts of the scene that they may hit "
                    "(Caspary, Jevans)",
     .decide = distribute_ray},
    {.name = "ring",
     .description =
         "rays go around all ranks; parts of the scene move to less loaded neighbours (Kim)",
     .decide = nullptr},
    {.name = "hybrid",
     .description = "rays or parts of the scene are sent, whichever the queues favour (Nebel)",
     .decide = distribute_hybrid,
     .fetches = true,
     .chooses = true},
};

}  // namespace

std::span<const Distribution> distributions() { return kDistributions; }

const Distribution* find_distribution(std::string_view name) {
  return files::find_named(distributions(), name);
}

}  // namespace delray::raytrace
