// The samples of a tile: from walks to pixels.
#pragma once

#include <cstdint>
#include <vector>

#include "raytrace/internal/tiled_frame.h"

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

// Without samples yet; without pixels, where none of its squares is rendered.
TilePixels clear_tile(const TiledFrame& frame, std::uint32_t tile);

// The parts of a tile that are walked through at once, the first sample of each. Rays of so many
// pixels are traced, then shaded, and so on: they stay in the cache meanwhile.
std::vector<Task> tasks_of(const TiledFrame& frame, const geometry::Rect& tile);

// How many samples a task gets, one after the other.
int samples_of(const RenderOptions& options);

// What a walk that is done found. Samples of a pixel have to be added in ascending order.
void add_samples(const Walk& walk, const Task& task, int samples, TilePixels& pixels);

// All samples, on the calling thread.
TilePixels sample_tile(const TiledFrame& frame, std::uint32_t tile);

// Processor time of this thread: ranks may share a core, and waiting is no work.
double thread_seconds();

}  // namespace delray::raytrace
