// The samples of a tile: from walks to pixels.
#pragma once

#include <cstdint>
#include <vector>

#include "raytrace/internal/frame.h"

namespace delray::raytrace {

// A tile's pixels, row by row, and what they took.
struct TilePixels {
  std::uint32_t tile = 0;
  geometry::Rect rect;
  std::vector<image::RgbaF> colour;
  std::vector<float> depth;
  RayCounts rays;
  double busy = 0.0;  // seconds of processor time
};

// Without samples yet.
TilePixels clear_tile(const loadbalance::Blocks& tiles, std::uint32_t tile);

// The parts of a tile that are walked through at once, sample 0 of each. Rays of so many pixels are
// traced, then shaded, and so on: they stay in the cache meanwhile.
std::vector<Task> tasks_of(const geometry::Rect& tile);

// What a walk that is done found. Samples of a pixel have to be added in ascending order.
void add_samples(const Walk& walk, const Task& task, int samples, TilePixels& pixels);

// All samples, on the calling thread.
TilePixels sample_tile(const Frame& frame, std::uint32_t tile);

// Processor time of this thread: ranks may share a core, and waiting is no work.
double thread_seconds();

}  // namespace delray::raytrace
