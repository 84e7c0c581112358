// Frames of the rasterizer on the simulated machine, sorted by what reports tell of them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "apps/compare/spread.h"
#include "apps/render/render_frames.h"
#include "comm/network.h"
#include "raster/simulated_frames.h"

namespace delray::apps {

// How many frames of each kind follow the first.
struct FrameCounts {
  int at_rest = 1, turning = 0;
};

struct SimulatedFrames {
  raster::SimulatedFrame first;                 // the screen is cut, and primitives travel
  std::vector<raster::SimulatedFrame> next;     // as in an animation that stands still
  std::vector<raster::SimulatedFrame> turning;  // the camera goes on round a turntable
  image::Image8 picture;                        // before a background
  std::uint64_t resident_bytes = 0;             // as raster::SimulatedFrames
};

// REQUIRES: ranks, counts.at_rest >= 1. Throws as raster::simulate_frames does.
SimulatedFrames simulate_frames(const Prepared& prepared, const raster::RenderOptions& options,
                                int ranks, const FrameCounts& counts, parallel::Progress* progress);

// Seconds from the scene in memory to the picture on rank 0, on a machine with a core for each rank
// and this network.
double seconds_over(const raster::SimulatedFrame& frame, const comm::Network& network);
Spread seconds_over(std::span<const raster::SimulatedFrame> frames, const comm::Network& network);

}  // namespace delray::apps
