#include "raytrace/render.h"

#include <time.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <memory>
#include <mutex>
#include <utility>

#include "comm/collectives.h"
#include "geometry/rect.h"
#include "parallel/parallel_for.h"
#include "raytrace/answer.h"
#include "raytrace/flush_to_zero.h"
#include "raytrace/tiles.h"

namespace delray::raytrace {
namespace {

using geometry::Rect;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Processor time of this thread: ranks may share a core, and waiting is no work.
double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// A tile's pixels, row by row.
struct TilePixels {
  std::vector<image::RgbaF> colour;
  std::vector<float> depth;
  RayCounts rays;
  double busy = 0.0;
};

// Walks that are at rest between the tiles of a frame: one for each thread, in the end.
class Walks {
 public:
  Walks(const Integrator& integrator, const Setting& setting)
      : integrator_(integrator), setting_(setting) {}

  std::unique_ptr<Walk> take() {
    {
      const std::lock_guard lock(mutex_);
      if (!resting_.empty()) {
        std::unique_ptr<Walk> walk = std::move(resting_.back());
        resting_.pop_back();
        return walk;
      }
    }
    return integrator_.make(setting_);
  }
  void give(std::unique_ptr<Walk> walk) {
    const std::lock_guard lock(mutex_);
    resting_.push_back(std::move(walk));
  }

 private:
  const Integrator& integrator_;
  const Setting& setting_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Walk>> resting_;
};

// What all tiles of a frame have in common.
struct TiledFrame {
  const Tracer& tracer;
  const RenderOptions& options;
  const Setting& setting;
  Walks& walks;
  std::vector<Rect> tiles;
  std::vector<std::uint32_t> mine;
};

// Rays of so many pixels are traced, then shaded, and so on: they stay in the cache meanwhile.
constexpr int kTaskSide = 16;
static_assert(kTileSide % kTaskSide == 0 && kTaskSide % kBlockSide == 0);

void add_samples(const Walk& walk, const Task& task, float weight, const Rect& tile,
                 TilePixels& pixels) {
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
}

TilePixels trace_tile(const TiledFrame& frame, const Rect& tile) {
  const FlushToZero flush;
  const double start = thread_seconds();
  TilePixels pixels;
  pixels.colour.resize(static_cast<std::size_t>(tile.area()));
  pixels.depth.assign(pixels.colour.size(), image::kEmptyDepth);
  const float weight = 1.0F / static_cast<float>(frame.options.samples);
  std::unique_ptr<Walk> walk = frame.walks.take();
  for (int y = tile.y0; y < tile.y1; y += kTaskSide) {
    for (int x = tile.x0; x < tile.x1; x += kTaskSide) {
      Task task;
      task.pixels = geometry::intersection(tile, {x, y, x + kTaskSide, y + kTaskSide});
      for (int s = 0; s < frame.options.samples; ++s) {
        task.first_sample = s;
        for (walk->start(task); !walk->done(); walk->go_on()) answer(frame.tracer, walk->wave());
        add_samples(*walk, task, weight, tile, pixels);
        pixels.rays += walk->rays();
      }
    }
  }
  frame.walks.give(std::move(walk));
  pixels.busy = thread_seconds() - start;
  return pixels;
}

void put(const Rect& tile, const image::RgbaF* colour, const float* depth, image::ImageF& image) {
  const auto width = static_cast<std::size_t>(tile.width());
  for (int y = tile.y0; y < tile.y1; ++y) {
    const std::size_t to = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                           static_cast<std::size_t>(tile.x0);
    const std::size_t from = static_cast<std::size_t>(y - tile.y0) * width;
    std::copy_n(colour + from, width, image.colour.data() + to);
    std::copy_n(depth + from, width, image.depth.data() + to);
  }
}

// A rank's message: statistics, then the colours of all its tiles, then their depths.
comm::Buffer pack(const RankStatistics& statistics, std::span<const TilePixels> traced) {
  std::size_t pixels = 0;
  for (const TilePixels& tile : traced) pixels += tile.depth.size();
  comm::Buffer message(sizeof(RankStatistics) + pixels * (sizeof(image::RgbaF) + sizeof(float)));
  std::memcpy(message.data(), &statistics, sizeof(RankStatistics));
  std::byte* colour = message.data() + sizeof(RankStatistics);
  std::byte* depth = colour + pixels * sizeof(image::RgbaF);
  for (const TilePixels& tile : traced) {
    if (tile.depth.empty()) continue;
    const std::size_t n = tile.depth.size();
    std::memcpy(colour, tile.colour.data(), n * sizeof(image::RgbaF));
    std::memcpy(depth, tile.depth.data(), n * sizeof(float));
    colour += n * sizeof(image::RgbaF);
    depth += n * sizeof(float);
  }
  return message;
}

void unpack(const comm::Buffer& message, std::span<const Rect> tiles,
            std::span<const std::uint32_t> numbers, image::ImageF& image) {
  std::size_t pixels = 0;
  for (const std::uint32_t number : numbers) {
    pixels += static_cast<std::size_t>(tiles[number].area());
  }
  // The statistics are a multiple of 8 bytes, so both planes are aligned where they lie.
  const auto* colour =
      reinterpret_cast<const image::RgbaF*>(message.data() + sizeof(RankStatistics));
  const auto* depth = reinterpret_cast<const float*>(colour + pixels);
  for (const std::uint32_t number : numbers) {
    put(tiles[number], colour, depth, image);
    colour += tiles[number].area();
    depth += tiles[number].area();
  }
}

std::vector<TilePixels> trace(const TiledFrame& frame) {
  std::vector<TilePixels> traced(frame.mine.size());
  parallel::Progress* progress = frame.options.progress;
  if (progress != nullptr) progress->start(frame.mine.size());
  parallel::parallel_for(0, traced.size(), 1, [&](std::size_t i) {
    traced[i] = trace_tile(frame, frame.tiles[frame.mine[i]]);
    if (progress != nullptr) progress->advance();
  });
  return traced;
}

// Everything to rank 0, whose own tiles go straight into the image.
void collect(comm::Communicator& communicator, const TiledFrame& frame,
             std::span<const TilePixels> traced, RankStatistics mine, const Schedule& dealt,
             Result& result) {
  const bool root = communicator.rank() == 0;
  comm::Buffer message;
  if (!root) {
    mine.messages = 1;
    message = pack(mine, traced);
    mine.bytes_sent = message.size();
    std::memcpy(message.data(), &mine, sizeof(mine));
  }
  const std::vector<comm::Buffer> messages = comm::gather(communicator, 0, std::move(message));
  if (!root) return;
  result.image = image::ImageF(frame.setting.view.width, frame.setting.view.height);
  parallel::parallel_for(0, traced.size(), 16, [&](std::size_t i) {
    put(frame.tiles[frame.mine[i]], traced[i].colour.data(), traced[i].depth.data(), result.image);
  });
  std::vector<RankStatistics>& ranks = result.statistics.ranks;
  ranks.assign(static_cast<std::size_t>(communicator.size()), mine);
  for (int rank = 1; rank < communicator.size(); ++rank) {
    const comm::Buffer& from = messages[rank];
    std::memcpy(&ranks[rank], from.data(), sizeof(RankStatistics));
    ranks[0].bytes_received += from.size();
    unpack(from, frame.tiles,
           tiles_of_rank(dealt, frame.setting.view.width, frame.setting.view.height, rank,
                         communicator.size()),
           result.image);
  }
  for (const RankStatistics& rank : ranks) result.statistics.rays += rank.rays;
}

}  // namespace

Result render(comm::Communicator& communicator, const Tracer& tracer, const scenes::Camera& camera,
              const RenderOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const Schedule& dealt = schedule(options.schedule);
  const Integrator& chosen = integrator(options.integrator);
  const int width = std::max(0, options.width), height = std::max(0, options.height);
  scenes::View view;
  if (width > 0 && height > 0) view = scenes::make_view(camera, width, height);
  view.width = width;
  view.height = height;
  const shading::BatchShader shader = shading::make_batch_shader(tracer.shader);
  const Setting setting{shader, tracer.lights, view, options.trace, options.samples};
  Walks walks(chosen, setting);
  const TiledFrame frame{
      tracer,
      options,
      setting,
      walks,
      tiles(width, height),
      tiles_of_rank(dealt, width, height, communicator.rank(), communicator.size())};

  communicator.mark(comm::Phase::trace, 0);
  const std::vector<TilePixels> traced = trace(frame);
  RankStatistics mine;
  mine.tasks = traced.size();
  for (const TilePixels& tile : traced) {
    mine.busy += tile.busy;
    mine.rays += tile.rays;
  }
  communicator.work(comm::Work::rays, mine.rays.primary + mine.rays.shadow + mine.rays.secondary);

  Result result;
  Statistics& statistics = result.statistics;
  statistics.trace_seconds = seconds_since(start);
  communicator.mark(comm::Phase::gather, 0);
  collect(communicator, frame, traced, mine, dealt, result);
  statistics.build_seconds = tracer.build_seconds;
  statistics.frame_seconds = seconds_since(start);
  statistics.gather_seconds = statistics.frame_seconds - statistics.trace_seconds;
  statistics.degenerate = tracer.degenerate;
  statistics.structure_bytes = tracer.embree.memory();
  statistics.embree_version = tracer.embree.version();
  statistics.embree_isa = tracer.embree.isa();
  return result;
}

Result render(comm::Communicator& communicator, const scenes::Scene& scene,
              const scenes::Camera& camera, const RenderOptions& options) {
  const Tracer tracer = make_tracer(scene, options.build);
  return render(communicator, tracer, camera, options);
}

}  // namespace delray::raytrace
