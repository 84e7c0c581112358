// Cuts a tile into tasks whose rays stay in the cache, runs the integrator sample after sample, and
// adds what it finds to the pixels.
//
// A first and only sample is written past the caches, a cache line at a time. Degenerate: squares
// that a part leaves out are not rendered, and a tile without any has no pixels.
#include "raytrace/integrators/sample_tile.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#include "parallel/processor_time.h"
#include "raytrace/integrators/intersect.h"
#include "raytrace/scene/flush_to_zero.h"

namespace delray::raytrace {

using geometry::Rect;

static_assert(kTaskSide % kBlockSide == 0);

double thread_seconds() {
  return 1e-9 * static_cast<double>(parallel::quick_processor_nanoseconds());
}

namespace {

// The tile and what its packets, or other squares of such a side, show beside it of the window.
Rect with_whole_packets(const TiledFrame& frame, const Rect& tile, int side) {
  const Rect& window = frame.tiles.frame;
  const auto down = [side](int at, int origin) { return at - (at - origin) % side; };
  const auto up = [side](int at, int origin) { return at + (side - (at - origin) % side) % side; };
  return geometry::intersection(window, {down(tile.x0, window.x0), down(tile.y0, window.y0),
                                         up(tile.x1, window.x0), up(tile.y1, window.y0)});
}

}  // namespace

TilePixels start_tile(const TiledFrame& frame, std::uint32_t tile) {
  TilePixels pixels;
  pixels.tile = tile;
  pixels.rect = frame.tiles.block(tile);
  if (tasks_of(frame, pixels.rect).empty()) return pixels;
  const auto count = static_cast<std::size_t>(pixels.rect.area());
  pixels.pixels = static_cast<std::uint32_t>(count);
  if (frame.picture != nullptr) {
    const Rect& window = frame.tiles.frame;
    pixels.stride = static_cast<std::size_t>(frame.picture->width);
    const std::size_t first = static_cast<std::size_t>(pixels.rect.y0 - window.y0) * pixels.stride +
                              static_cast<std::size_t>(pixels.rect.x0 - window.x0);
    pixels.colour = frame.picture->colour.data() + first;
    pixels.depth = frame.picture->depth.data() + first;
    return pixels;
  }
  pixels.stride = static_cast<std::size_t>(pixels.rect.width());
  pixels.own_colour.resize(count);
  pixels.own_depth.assign(count, image::kEmptyDepth);
  pixels.colour = pixels.own_colour.data();
  pixels.depth = pixels.own_depth.data();
  return pixels;
}

int samples_of(const RenderOptions& options) {
  return options.part.samples > 0 ? options.part.samples
                                  : options.samples - options.part.first_sample;
}

std::vector<Task> tasks_of(const TiledFrame& frame, const Rect& tile, int side) {
  const Part& part = frame.options.part;
  const Rect& window = frame.tiles.frame;
  const auto columns = static_cast<std::size_t>((window.width() + kTaskSide - 1) / kTaskSide);
  if (!part.squares.empty()) side = kTaskSide;
  const Rect whole = with_whole_packets(frame, tile, part.squares.empty() ? kBlockSide : kTaskSide);
  std::vector<Task> tasks;
  for (int y = whole.y0; y < whole.y1; y += side) {
    for (int x = whole.x0; x < whole.x1; x += side) {
      const std::size_t square = static_cast<std::size_t>((y - window.y0) / kTaskSide) * columns +
                                 static_cast<std::size_t>((x - window.x0) / kTaskSide);
      if (!part.squares.empty() && part.squares[square] == 0) continue;
      Task& task = tasks.emplace_back();
      task.pixels = geometry::intersection(whole, {x, y, x + side, y + side});
      task.first_sample = part.first_sample;
    }
  }
  return tasks;
}

std::uint64_t surplus_of(const TiledFrame& frame, const Rect& tile, const Task& task) {
  const Rect own = geometry::intersection(tile, task.pixels);
  if (own == task.pixels) return 0;
  const std::span<const std::uint8_t> traced = frame.options.part.pixels;
  if (traced.empty()) return static_cast<std::uint64_t>(task.pixels.area() - own.area());
  std::uint64_t count = 0;
  for (int y = task.pixels.y0; y < task.pixels.y1; ++y) {
    for (int x = task.pixels.x0; x < task.pixels.x1; ++x) {
      const std::size_t pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.options.width) +
          static_cast<std::size_t>(x);
      count += traced[pixel] != 0 && !own.contains(x, y) ? 1 : 0;
    }
  }
  return count;
}

namespace {

// Adds `weight` times lanes of a block, the `own` ones of its columns and rows, to pixels, of which
// colour and depth are the first, or overwrites those with it.
template <bool kFirst>
void add_block(const SampleBlock& block, float weight, const Rect& own, image::RgbaF* colour,
               float* depth, std::size_t stride) {
  for (int y = own.y0; y < own.y1; ++y, colour += stride, depth += stride) {
    for (int x = 0; x < own.width(); ++x) {
      const int i = y * kBlockSide + own.x0 + x;
      const image::RgbaF sum = kFirst ? image::RgbaF{} : colour[x];
      colour[x] = {sum.r + block.colour.x[i] * weight, sum.g + block.colour.y[i] * weight,
                   sum.b + block.colour.z[i] * weight, sum.a + block.alpha[i] * weight};
      depth[x] = kFirst ? block.depth[i] : std::min(depth[x], block.depth[i]);
    }
  }
}

#if defined(__SSE__)

// A row of a block is a cache line: it goes to memory without being read first, and is not kept.
void write_past_caches(const SampleBlock& block, float weight, image::RgbaF* colour, float* depth,
                       std::size_t stride) {
  const __m128 weights = _mm_set1_ps(weight), zero = _mm_setzero_ps();
  for (int i = 0; i < kPacketRays; i += kBlockSide, colour += stride, depth += stride) {
    const auto weighed = [&](const shading::Floats16& v) {
      return _mm_add_ps(zero, _mm_mul_ps(_mm_load_ps(v.lane + i), weights));
    };
    __m128 r = weighed(block.colour.x), g = weighed(block.colour.y);
    __m128 b = weighed(block.colour.z), a = weighed(block.alpha);
    _MM_TRANSPOSE4_PS(r, g, b, a);
    _mm_stream_ps(&colour[0].r, r);
    _mm_stream_ps(&colour[1].r, g);
    _mm_stream_ps(&colour[2].r, b);
    _mm_stream_ps(&colour[3].r, a);
    std::memcpy(depth, block.depth.lane + i, kBlockSide * sizeof(float));
  }
}

// Whether nobody reads the pixels of the block before all of the picture is done.
bool may_pass_caches(const TiledFrame& frame, const image::RgbaF* colour) {
  return frame.picture != nullptr && samples_of(frame.options) == 1 &&
         reinterpret_cast<std::uintptr_t>(colour) % 16 == 0;
}

// Others see what was written once this thread has told them that it is done.
void finish_writes() { _mm_sfence(); }

#else

void write_past_caches(const SampleBlock& block, float weight, image::RgbaF* colour, float* depth,
                       std::size_t stride) {
  add_block<true>(block, weight, {0, 0, kBlockSide, kBlockSide}, colour, depth, stride);
}
bool may_pass_caches(const TiledFrame&, const image::RgbaF*) { return false; }
void finish_writes() {}

#endif

}  // namespace

void add_samples(const TiledFrame& frame, std::span<const SampleBlock> samples, const Task& task,
                 const TilePixels& pixels) {
  const float weight = 1.0F / static_cast<float>(samples_of(frame.options));
  const bool first = task.first_sample == frame.options.part.first_sample;
  const Rect& tile = pixels.rect;
  const SampleBlock* block = samples.data();
  const bool past_caches = first && may_pass_caches(frame, pixels.colour);
  const Rect inside = geometry::intersection(task.pixels, tile);
  for (int y = task.pixels.y0; y < task.pixels.y1; y += kBlockSide) {
    for (int x = task.pixels.x0; x < task.pixels.x1; x += kBlockSide, ++block) {
      const Rect own = geometry::intersection(inside, {x, y, x + kBlockSide, y + kBlockSide});
      if (own.empty()) continue;
      const std::size_t at = static_cast<std::size_t>(own.y0 - tile.y0) * pixels.stride +
                             static_cast<std::size_t>(own.x0 - tile.x0);
      if (past_caches && own.area() == kPacketRays) {
        write_past_caches(*block, weight, pixels.colour + at, pixels.depth + at, pixels.stride);
        continue;
      }
      const auto add = first ? add_block<true> : add_block<false>;
      add(*block, weight, {own.x0 - x, own.y0 - y, own.x1 - x, own.y1 - y}, pixels.colour + at,
          pixels.depth + at, pixels.stride);
    }
  }
  if (past_caches) finish_writes();
}

TilePixels sample_tile(const TiledFrame& frame, std::uint32_t tile,
                       WavefrontIntegrator& integrator) {
  const FlushToZero flush;
  const double start = thread_seconds();
  TilePixels pixels = start_tile(frame, tile);
  const int samples = samples_of(frame.options);
  FirstHits::Memory memory;
  for (Task& task : tasks_of(frame, pixels.rect, frame.integrators.side())) {
    for (int s = 0; s < samples; ++s, ++task.first_sample) {
      integrator.start(task);
      if (frame.first_hits != nullptr && !integrator.done()) {
        RayBatch& batch = integrator.batch();
        pixels.rays.rasterized += frame.first_hits->find(task.pixels, batch.rays, memory);
        intersect_rest(*frame.tracer, batch, memory.left);
        integrator.advance();
      }
      for (; !integrator.done(); integrator.advance()) {
        intersect(*frame.tracer, frame.context.shader, integrator.batch());
      }
      add_samples(frame, integrator.samples(), task, pixels);
      pixels.rays += integrator.rays();
      pixels.rays.surplus += surplus_of(frame, pixels.rect, task);
    }
  }
  pixels.busy = thread_seconds() - start;
  return pixels;
}

}  // namespace delray::raytrace
