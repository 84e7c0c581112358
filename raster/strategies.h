// How a scene is shared out among ranks (Molnar et al. 1994).
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "raster/render.h"

namespace delray::raster {

struct RankContext;

// One rank's part of a frame, in steps that follow each other. Frames may be in different steps
// at the same time; only `compose` uses the communicator.
class FrameSteps {
 public:
  virtual ~FrameSteps() = default;
  virtual void transform() = 0;
  virtual void rasterize() = 0;
  // Collective. As Strategy::render.
  virtual Picture compose() = 0;
};

// An entry of the table of strategies.
struct Strategy {
  const char* name;
  const char* description;
  // Collective. The picture on rank 0, with depths as -near / distance; of size 0 elsewhere.
  Picture (*render)(RankContext& rank);
  // As `render`, in steps; null where ranks exchange messages before they draw, or where what one
  // frame took decides how the next is shared out.
  std::unique_ptr<FrameSteps> (*steps)(RankContext& rank) = nullptr;
  // Which of RenderOptions it looks at:
  bool composites = false;  // scheme, codec, blend; Shade::composited
  bool costs = false;       // costs
  bool partitions = false;  // partition, regions_per_rank, keep_factor
  bool travels = false;     // travel
  bool schedules = false;   // schedule, block, master_works
  bool groups = false;      // groups, geometry_ranks, redistribution
  bool displays = false;    // owners_draw
  bool packs = false;       // reads packs, each rank what it draws
  bool parts = false;       // renders scenes of which every rank has a part
};

// The table: --list, tests, benchmarks and reports iterate over it.
std::span<const Strategy> strategies();
const Strategy* find_strategy(std::string_view name);  // nullptr when there is none

}  // namespace delray::raster
