#include "raytrace/internal/sample_tile.h"

#include <time.h>

#include <algorithm>

#include "raytrace/answer.h"
#include "raytrace/flush_to_zero.h"

namespace delray::raytrace {

using geometry::Rect;

static_assert(kTaskSide % kBlockSide == 0);

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

TilePixels clear_tile(const TiledFrame& frame, std::uint32_t tile) {
  TilePixels pixels;
  pixels.tile = tile;
  pixels.rect = frame.tiles.block(tile);
  if (tasks_of(frame, pixels.rect).empty()) return pixels;
  pixels.colour.resize(static_cast<std::size_t>(pixels.rect.area()));
  pixels.depth.assign(pixels.colour.size(), image::kEmptyDepth);
  return pixels;
}

int samples_of(const RenderOptions& options) {
  return options.part.samples > 0 ? options.part.samples
                                  : options.samples - options.part.first_sample;
}

std::vector<Task> tasks_of(const TiledFrame& frame, const Rect& tile) {
  const Part& part = frame.options.part;
  const Rect& window = frame.tiles.frame;
  const auto columns = static_cast<std::size_t>((window.width() + kTaskSide - 1) / kTaskSide);
  std::vector<Task> tasks;
  for (int y = tile.y0; y < tile.y1; y += kTaskSide) {
    for (int x = tile.x0; x < tile.x1; x += kTaskSide) {
      const std::size_t square = static_cast<std::size_t>((y - window.y0) / kTaskSide) * columns +
                                 static_cast<std::size_t>((x - window.x0) / kTaskSide);
      if (!part.squares.empty() && part.squares[square] == 0) continue;
      Task& task = tasks.emplace_back();
      task.pixels = geometry::intersection(tile, {x, y, x + kTaskSide, y + kTaskSide});
      task.first_sample = part.first_sample;
    }
  }
  return tasks;
}

void add_samples(const Walk& walk, const Task& task, int samples, TilePixels& pixels) {
  const float weight = 1.0F / static_cast<float>(samples);
  const Rect& tile = pixels.rect;
  const SampleBlock* block = walk.samples().data();
  for (int y = task.pixels.y0; y < task.pixels.y1; y += kBlockSide) {
    for (int x = task.pixels.x0; x < task.pixels.x1; x += kBlockSide, ++block) {
      for (int i = 0; i < kPacketRays; ++i) {
        const int column = x + i % kBlockSide, row = y + i / kBlockSide;
        if (column >= task.pixels.x1 || row >= task.pixels.y1) continue;
        const auto at =
            static_cast<std::size_t>(row - tile.y0) * static_cast<std::size_t>(tile.width()) +
            static_cast<std::size_t>(column - tile.x0);
        image::RgbaF& sum = pixels.colour[at];
        sum = {sum.r + block->colour.x[i] * weight, sum.g + block->colour.y[i] * weight,
               sum.b + block->colour.z[i] * weight, sum.a + block->alpha[i] * weight};
        pixels.depth[at] = std::min(pixels.depth[at], block->depth[i]);
      }
    }
  }
  pixels.rays += walk.rays();
}

TilePixels sample_tile(const TiledFrame& frame, std::uint32_t tile) {
  const FlushToZero flush;
  const double start = thread_seconds();
  TilePixels pixels = clear_tile(frame, tile);
  const int samples = samples_of(frame.options);
  std::unique_ptr<Walk> walk = frame.walks.take();
  for (Task& task : tasks_of(frame, pixels.rect)) {
    for (int s = 0; s < samples; ++s, ++task.first_sample) {
      for (walk->start(task); !walk->done(); walk->go_on()) answer(*frame.tracer, walk->wave());
      add_samples(*walk, task, samples, pixels);
    }
  }
  frame.walks.give(std::move(walk));
  pixels.busy = thread_seconds() - start;
  return pixels;
}

}  // namespace delray::raytrace
