#include "raster/strategies.h"

#include <algorithm>
#include <array>

#include "raster/internal/rank.h"

namespace delray::raster {
namespace {

constexpr std::array kStrategies = {
    Strategy{"sort-last", "each rank draws its primitives; the images are composited", sort_last,
             sort_last_steps},
    Strategy{"sort-first", "primitives go to the ranks whose regions of the screen they touch",
             sort_first},
    Strategy{"sort-middle", "transformed triangles go to the ranks whose regions they touch",
             sort_middle},
    Strategy{"hybrid",
             "each primitive goes to one rank; pixels go from where they are drawn to their owners",
             hybrid},
};

}  // namespace

std::span<const Strategy> strategies() { return kStrategies; }

const Strategy* find_strategy(std::string_view name) {
  const auto* found = std::find_if(kStrategies.begin(), kStrategies.end(),
                                   [&](const Strategy& s) { return s.name == name; });
  return found == kStrategies.end() ? nullptr : found;
}

}  // namespace delray::raster
