// How a scene is shared out among ranks (Molnar et al. 1994).
#pragma once

#include <span>
#include <string_view>

#include "raster/render.h"

namespace delray::raster {

struct Rank;

struct Strategy {
  const char* name;
  const char* description;
  // Collective. The picture on rank 0, with depths as -near / distance; of size 0 elsewhere.
  Picture (*render)(Rank& rank);
};

// The table: --list, tests, benchmarks and reports iterate over it.
std::span<const Strategy> strategies();
const Strategy* find_strategy(std::string_view name);  // nullptr when there is none

}  // namespace delray::raster
