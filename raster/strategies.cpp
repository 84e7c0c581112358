// The table of strategies: their functions, and which options each looks at.
#include "raster/strategies.h"

#include <array>

#include "files/find_named.h"
#include "raster/distribute/rank_context.h"

namespace delray::raster {
namespace {

constexpr std::array kStrategies = {
    Strategy{
        .name = "sort-last",
        .description = "each rank draws its own primitives; the images of all ranks are composited",
        .render = sort_last,
        .steps = sort_last_steps,
        .composites = true,
        .costs = true,
        .packs = true,
        .parts = true},
    Strategy{.name = "sort-first",
             .description = "primitives go to the ranks whose regions of the screen they touch, "
                            "before they are drawn",
             .render = sort_first,
             .costs = true,
             .partitions = true,
             .travels = true,
             .schedules = true,
             .displays = true,
             .packs = true},
    Strategy{.name = "sort-middle",
             .description = "triangles go to the ranks whose regions of the screen they touch, "
                            "once transformed",
             .render = sort_middle,
             .costs = true,
             .partitions = true,
             .groups = true,
             .displays = true,
             .parts = true},
    Strategy{
        .name = "hybrid",
        .description = "each primitive is drawn by one rank; pixels go to the ranks that own them",
        .render = hybrid,
        .costs = true,
        .partitions = true,
        .travels = true},
};

}  // namespace

std::span<const Strategy> strategies() { return kStrategies; }

const Strategy* find_strategy(std::string_view name) {
  return files::find_named(strategies(), name);
}

}  // namespace delray::raster
