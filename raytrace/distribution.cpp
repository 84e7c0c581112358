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
     .decide = distribute_ray,
     .plans_tiles = true,
     .uneven = 0.4},
    {.name = "ring",
     .description =
         "rays go around all ranks; parts of the scene move to less loaded neighbours (Kim)",
     .decide = nullptr},
    {.name = "voxels",
     .description = "space in equal voxels, dealt to ranks at random; triangles are clipped to "
                    "them, and rays travel (Jevans)",
     .decide = distribute_ray,
     .division = ShareOptions::Division::voxels},
    {.name = "packed-voxels",
     .description = "the same voxels, which ranks fetch whole and compressed, and cache (Wald)",
     .decide = distribute_object,
     .fetches = true,
     .plans_tiles = true,
     .division = ShareOptions::Division::voxels,
     .compresses = true},
    {.name = "hybrid-by-load",
     .description = "rays go to ranks that have fewer, else parts of the scene are fetched; every "
                    "message tells its sender's load (Nebel)",
     .decide = distribute_by_load,
     .fetches = true,
     .tells_loads = true},
    {.name = "hybrid",
     .description = "rays or parts of the scene are sent, whichever took less time lately",
     .decide = distribute_hybrid,
     .fetches = true,
     .chooses = true},
};

}  // namespace

std::span<const Distribution> distributions() { return kDistributions; }

ShareOptions share_options(const Distribution& distribution, ShareOptions options) {
  options.division = distribution.division;
  options.compresses = distribution.compresses;
  return options;
}

const Distribution* find_distribution(std::string_view name) {
  return files::find_named(distributions(), name);
}

}  // namespace delray::raytrace
