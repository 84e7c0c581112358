// The samples of a tile: from integrators to pixels.
#pragma once

#include <cstdint>
#include <vector>

#include "raytrace/integrators/tiled_frame.h"

namespace delray::raytrace {

// A tile's pixels and what they took.
struct TilePixels {
  std::uint32_t tile = 0;
  geometry::Rect rect;
  std::uint32_t pixels = 0;  // that are rendered; 0: none of its squares are
  // Where its first pixel is and, `stride` pixels further, the one below: in a picture, or in
  // memory of its own, row by row.
  image::RgbaF* colour = nullptr;
  float* depth = nullptr;
  std::size_t stride = 0;
  std::vector<image::RgbaF> own_colour;
  std::vector<float> own_depth;
  RayCounts rays;
  double busy = 0.0;  // seconds of processor time
};

// Without samples yet: what is in its pixels is overwritten by the first one.
TilePixels start_tile(const TiledFrame& frame, std::uint32_t tile);

// The parts of a tile that are walked through at once, the first sample of each. Rays of so many
// pixels are traced, then shaded, and so on: they stay in the cache meanwhile. Together they are
// the tile with all of the packets that it cuts. `side`: of the largest, a multiple of kTaskSide.
std::vector<Task> tasks_of(const TiledFrame& frame, const geometry::Rect& tile,
                           int side = kTaskSide);

// How many samples a task gets, one after the other.
int samples_of(const RenderOptions& options);

// How many pixels of a task are traced and belong to other tiles.
std::uint64_t surplus_of(const TiledFrame& frame, const geometry::Rect& tile, const Task& task);

// Adds the samples of an integrator that is done to the pixels, but not its rays: tasks of a tile
// may do so at the same time. Samples of a pixel have to be added in ascending order.
void add_samples(const TiledFrame& frame, std::span<const SampleBlock> samples, const Task& task,
                 const TilePixels& pixels);

// All samples, on the calling thread. `integrator` is of frame.integrators and at rest.
TilePixels sample_tile(const TiledFrame& frame, std::uint32_t tile,
                       WavefrontIntegrator& integrator);

// Processor time of this thread: ranks may share a core, and waiting is no work.
double thread_seconds();

}  // namespace delray::raytrace
