#include "raster/internal/regions.h"

#include <atomic>

#include "parallel/parallel_for.h"
#include "raster/internal/processor_seconds.h"
#include "raster/internal/shade_gouraud.h"

namespace delray::raster {

template <class Colour>
RegionCounts render_regions(const Screen& screen, const DrawList& list,
                            const shading::Shader& shader, const RenderOptions& options,
                            std::span<const geometry::Rect> regions, bool distances,
                            Scratch& scratch, image::BasicImage<Colour>& image,
                            parallel::Progress* progress) {
  RegionCounts counts;
  const TileJobs tiles = make_tile_jobs(screen, regions);
  if (progress != nullptr) progress->start(tiles.jobs.size());
  const std::vector<PreparedDraw> draws =
      prepare_draws(screen, list, shader, options.cull_single_sided);
  const FrameShading frame = make_frame_shading(screen, shader, list, options.lighting, distances);
  scratch.tiles.begin(screen, tiles);

  // Which frame the triangles that a thread remembers belong to.
  static std::atomic<std::uint64_t> frames{0};
  const std::uint64_t this_frame = ++frames;
  const auto seen_triangles = [&]() -> SeenTriangles& {
    static thread_local SeenTriangles seen;
    static thread_local std::uint64_t seen_in = 0;
    if (seen_in != this_frame) seen.clear();
    seen_in = this_frame;
    return seen;
  };
  const DrawIntoTiles task{screen,
                           list,
                           draws,
                           tiles.wanted,
                           options.skip_hidden_clusters,
                           [&](std::uint32_t number, int x, int y) {
                             return solid(frame, seen_triangles(), number, x, y);
                           },
                           progress};
  DrawSeconds seconds;
  counts.triangles = draw_into_tiles(task, scratch.tiles, scratch.workers, scratch.large, seconds);
  counts.phases.transform = seconds.set_up;
  counts.phases.bin = seconds.sort;

  ProcessorSeconds rasterize_seconds, shade_seconds;
  std::atomic<std::uint64_t> fragments{0};
  const auto shade = [&](const TileJob& job) -> std::uint64_t {
    const std::span<const geometry::Rect> rects = tiles.rects_of(job);
    if (!scratch.tiles.is_drawn_in(job.tile)) {
      for (const geometry::Rect& r : rects) clear_pixels(r, window_of(image));
      return 0;
    }
    std::uint64_t shaded = 0;
    const VisibilityTile& tile = scratch.tiles.open(job.tile);
    static thread_local GouraudTile gouraud;
    for (const geometry::Rect& r : rects)
      shaded += options.lighting == Lighting::gouraud
                    ? gouraud.shade(frame, seen_triangles(), tile, r, window_of(image))
                    : shade_tile(frame, seen_triangles(), tile, r, window_of(image));
    return shaded;
  };
  std::atomic<std::size_t> next{0};
  parallel::parallel_for(0, scratch.workers.size(), 1, [&](std::size_t) {
    StageClock<2> clock;
    std::uint64_t shaded = 0;
    for (;;) {
      const std::size_t k = next.fetch_add(1, std::memory_order_relaxed);
      if (k >= tiles.jobs.size()) break;
      draw_large(task, tiles.jobs[k].tile, scratch.large, scratch.tiles);
      clock.finish(0);
      shaded += shade(tiles.jobs[k]);
      clock.finish(1);
      if (progress != nullptr) progress->advance();
    }
    fragments.fetch_add(shaded, std::memory_order_relaxed);
    clock.add_to({&rasterize_seconds, &shade_seconds});
  });
  counts.phases.rasterize = seconds.rasterize + rasterize_seconds.seconds();
  counts.phases.shade = shade_seconds.seconds();
  counts.fragments = fragments;
  counts.tiles = tiles.jobs.size();
  return counts;
}

template RegionCounts render_regions(const Screen&, const DrawList&, const shading::Shader&,
                                     const RenderOptions&, std::span<const geometry::Rect>, bool,
                                     Scratch&, image::Image8&, parallel::Progress*);
template RegionCounts render_regions(const Screen&, const DrawList&, const shading::Shader&,
                                     const RenderOptions&, std::span<const geometry::Rect>, bool,
                                     Scratch&, image::ImageF&, parallel::Progress*);

}  // namespace delray::raster
