#include "raster/internal/regions.h"

#include <atomic>

#include "parallel/parallel_for.h"
#include "raster/internal/processor_seconds.h"

namespace delray::raster {

void RegionCounts::operator+=(const RegionCounts& other) {
  phases += other.phases;
  triangles += other.triangles;
  fragments += other.fragments;
  shaded += other.shaded;
  tiles += other.tiles;
}

RegionCounts render_regions(const RegionTask& task, Scratch& scratch, FinishTile finish) {
  const Screen& screen = task.screen;
  const RenderOptions& options = task.options;
  RegionCounts counts;
  const TileJobs tiles = make_tile_jobs(screen, task.regions);
  if (task.progress != nullptr) task.progress->start(tiles.jobs.size());
  const std::vector<PreparedDraw> draws =
      prepare_draws(screen, task.list, task.shader, options.cull_single_sided);
  const FrameShading frame =
      make_frame_shading(screen, task.shader, task.list, options.lighting, task.distances);
  scratch.tiles.begin(screen, tiles);

  // Which frame the triangles that a thread remembers belong to.
  static std::atomic<std::uint64_t> frames{0};
  const std::uint64_t this_frame = ++frames;
  const auto memory = [&]() -> TileMemory& {
    static thread_local TileMemory of_thread;
    static thread_local std::uint64_t seen_in = 0;
    if (seen_in != this_frame) of_thread.seen.clear();
    seen_in = this_frame;
    return of_thread;
  };
  DrawIntoTiles draw{
      screen,
      task.list,
      draws,
      tiles.wanted,
      options.skip_hidden_clusters,
      [&](std::uint32_t number, int x, int y) { return solid(frame, memory().seen, number, x, y); },
      {},
      task.progress};
  const bool shade_now = options.shade == Shade::immediate;
  if (shade_now) {
    const auto pixels =
        static_cast<std::size_t>(screen.width) * static_cast<std::size_t>(screen.height);
    if (scratch.shaded.size() < pixels) scratch.shaded = image::Plane<image::RgbaF>(pixels);
    draw.shade_now = [&](std::uint32_t number, int x, int y) {
      scratch.shaded[static_cast<std::size_t>(y) * static_cast<std::size_t>(screen.width) +
                     static_cast<std::size_t>(x)] = colour_at(frame, memory().seen, number, x, y);
    };
  }
  DrawCosts costs;
  counts.triangles = draw_into_tiles(draw, scratch.tiles, scratch.workers, scratch.later, costs);
  counts.phases.transform = costs.set_up;
  counts.phases.bin = costs.sort;

  ProcessorSeconds rasterize_seconds, shade_seconds;
  std::atomic<std::uint64_t> fragments{0}, shaded{costs.shaded};
  std::atomic<std::size_t> next{0};
  parallel::parallel_for(0, scratch.workers.size(), 1, [&](std::size_t) {
    StageClock<2> clock;
    TileMemory& mine = memory();
    std::uint64_t shaded_here = 0, shown_here = 0;
    for (;;) {
      const std::size_t k = next.fetch_add(1, std::memory_order_relaxed);
      if (k >= tiles.jobs.size()) break;
      const int index = tiles.jobs[k].tile;
      shaded_here += draw_large(draw, index, scratch.later.large, scratch.tiles);
      const VisibilityTile* const tile =
          scratch.tiles.is_drawn_in(index) ? &scratch.tiles.open(index) : nullptr;
      find_blended(screen, scratch.tiles.rect(index), scratch.later.blended.triangles,
                   scratch.later.blended.of_tile(index), tile, mine.blended);
      clock.finish(0);
      const geometry::Rect corner = screen.tile(index);
      const image::RgbaF* const colours =
          shade_now ? scratch.shaded.data() +
                          static_cast<std::ptrdiff_t>(corner.y0) * screen.width + corner.x0
                    : nullptr;
      TileView view(frame, tile, colours, mine);
      finish(tiles.rects_of(tiles.jobs[k]), view);
      clock.finish(1);
      shown_here += view.shown();
      shaded_here += view.shaded();
      if (task.progress != nullptr) task.progress->advance();
    }
    fragments.fetch_add(shown_here, std::memory_order_relaxed);
    shaded.fetch_add(shaded_here, std::memory_order_relaxed);
    clock.add_to({&rasterize_seconds, &shade_seconds});
  });
  counts.phases.rasterize = costs.rasterize + rasterize_seconds.seconds();
  counts.phases.shade = shade_seconds.seconds();
  counts.fragments = fragments;
  counts.shaded = shaded;
  counts.tiles = tiles.jobs.size();
  return counts;
}

}  // namespace delray::raster
