// Frames of the rasterizer by ranks that take turns on one thread of this process, each in its own
// time: what a rank does is measured as if it had a core of its own.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "apps/compare/spread.h"
#include "apps/render/render_frames.h"
#include "comm/ledger.h"
#include "comm/network.h"

namespace delray::apps {

struct SimulatedFrame {
  raster::Statistics statistics;
  comm::Ledger ledger;
};

struct SimulatedFrames {
  SimulatedFrame first;              // the screen is cut, and primitives travel
  std::vector<SimulatedFrame> next;  // as in an animation that stands still
  image::Image8 picture;             // before a background
};

// REQUIRES: ranks, repeats >= 1. Throws as raster::render does.
SimulatedFrames simulate_frames(const Prepared& prepared, const raster::RenderOptions& options,
                                int ranks, int repeats, parallel::Progress* progress);

// Seconds from the scene in memory to the picture on rank 0, on a machine with a core for each rank
// and this network.
double seconds_over(const SimulatedFrame& frame, const comm::Network& network);
Spread seconds_over(std::span<const SimulatedFrame> frames, const comm::Network& network);

}  // namespace delray::apps
