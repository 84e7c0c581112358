#include "raster/strategies.h"

#include <algorithm>
#include <array>

#include "raster/distribute/rank.h"

namespace delray::raster {
namespace {

constexpr std::array kStrategies = {
    Strategy{"sort-last",
             "each rank draws its own primitives; the images of all ranks are composited",
             sort_last, sort_last_steps},
    Strategy{
        "sort-first",
        "primitives go to the ranks whose regions of the screen they touch, before they are drawn",
        sort_first},
    Strategy{"sort-middle",
             "triangles go to the ranks whose regions of the screen they touch, once transformed",
             sort_middle},
    Strategy{"hybrid", "each primitive is drawn by one rank; pixels go to the ranks that own them",
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
