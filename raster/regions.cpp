#include "raster/internal/regions.h"

#include <algorithm>
#include <atomic>

#include "parallel/parallel_for.h"
#include "raster/internal/processor_seconds.h"

namespace delray::raster {
namespace {

// Vertices per task: some ten microseconds.
constexpr std::size_t kVertexGrain = 1 << 13;
// Clusters per bin: enough that the bin's table of tiles is small beside its triangles, and enough
// bins for every thread.
constexpr std::uint32_t kBinClusters = 8;

// The rectangles of a tile that are to be rendered.
struct TileJob {
  int tile = 0;
  std::uint32_t first = 0, last = 0;  // into TileJobs::rects
};
struct TileJobs {
  std::vector<TileJob> jobs;
  std::vector<geometry::Rect> rects;
  std::vector<std::uint8_t> wanted;  // by tile
};

TileJobs make_jobs(const Screen& screen, std::span<const geometry::Rect> regions) {
  struct Overlap {
    int tile;
    geometry::Rect rect;
  };
  std::vector<Overlap> overlaps;
  for (const geometry::Rect& region : regions) {
    const geometry::Rect r = geometry::intersection(region, screen.frame());
    if (r.empty()) continue;
    for (int y = r.y0 / kTileSize; y <= (r.y1 - 1) / kTileSize; ++y)
      for (int x = r.x0 / kTileSize; x <= (r.x1 - 1) / kTileSize; ++x) {
        const int tile = y * screen.tiles_x + x;
        overlaps.push_back({tile, geometry::intersection(r, screen.tile(tile))});
      }
  }
  std::stable_sort(overlaps.begin(), overlaps.end(),
                   [](const Overlap& a, const Overlap& b) { return a.tile < b.tile; });
  TileJobs result;
  result.wanted.assign(static_cast<std::size_t>(screen.tiles()), 0);
  for (const Overlap& overlap : overlaps) {
    const auto at = static_cast<std::uint32_t>(result.rects.size());
    if (result.jobs.empty() || result.jobs.back().tile != overlap.tile)
      result.jobs.push_back({overlap.tile, at, at});
    result.rects.push_back(overlap.rect);
    ++result.jobs.back().last;
    result.wanted[overlap.tile] = 1;
  }
  return result;
}

// Whether alpha may leave nothing of some pixels. Blended materials are drawn opaque, but not where
// there is nothing of them at all.
bool may_have_holes(const shading::Shader& shader, const scenes::Material& material,
                    const scenes::Mesh& mesh) {
  if (material.alpha == scenes::Material::Alpha::opaque) return false;
  return material.base_colour_texture != scenes::kNone || !mesh.colours.empty() ||
         !(shading::coverage(shader, material, {}, {}, 1.0F) > 0);
}

geometry::Rect hull(std::span<const geometry::Rect> rects) {
  geometry::Rect result = rects[0];
  for (const geometry::Rect& r : rects)
    result = {std::min(result.x0, r.x0), std::min(result.y0, r.y0), std::max(result.x1, r.x1),
              std::max(result.y1, r.y1)};
  return result;
}

}  // namespace

double prepare_draws(const Screen& screen, const DrawList& list, const shading::Shader& shader,
                     bool cull_single_sided, Scratch& scratch) {
  const std::size_t draws = list.draws.size();
  scratch.draws.resize(draws);
  std::size_t vertices = 0;
  for (const Draw& draw : list.draws) vertices += draw.vertices;
  if (scratch.vertices.size() < vertices) scratch.vertices.resize(vertices);

  std::size_t offset = 0;
  for (std::size_t i = 0; i < draws; ++i) {
    const Draw& draw = list.draws[i];
    const scenes::Material& material = shading::material(shader, draw.mesh->material);
    PreparedDraw& prepared = scratch.draws[i];
    prepared.draw = &draw;
    prepared.to_view = to_view(screen.view, *draw.transform);
    prepared.vertices = scratch.vertices.data() + offset;
    prepared.masked = may_have_holes(shader, material, *draw.mesh);
    prepared.hidden_side = 0;
    if (cull_single_sided && !material.double_sided) {
      // Counter-clockwise in the world is a negative area on the screen, where y grows downwards,
      // unless the transform mirrors.
      prepared.hidden_side = glm::determinant(glm::mat3(*draw.transform)) < 0 ? -1 : 1;
    }
    offset += draw.vertices;
  }

  ProcessorSeconds seconds;
  parallel::parallel_for(0, draws, 1, [&](std::size_t i) {
    const PreparedDraw& prepared = scratch.draws[i];
    const Draw& draw = *prepared.draw;
    ScreenVertex* const target =
        scratch.vertices.data() + (prepared.vertices - scratch.vertices.data());
    const std::span positions =
        std::span(draw.mesh->positions).subspan(draw.first_vertex, draw.vertices);
    parallel::parallel_blocks(0, draw.vertices, kVertexGrain, [&](std::size_t b, std::size_t e) {
      seconds.measure([&] {
        transform(prepared.to_view, screen, positions.subspan(b, e - b), {target + b, e - b});
      });
    });
  });
  return seconds.seconds();
}

template <class Colour>
RegionCounts render_regions(const Screen& screen, const DrawList& list,
                            const shading::Shader& shader, const RenderOptions& options,
                            std::span<const geometry::Rect> regions, Scratch& scratch,
                            image::BasicImage<Colour>& image, parallel::Progress* progress) {
  RegionCounts counts;
  const TileJobs tiles = make_jobs(screen, regions);
  if (progress != nullptr) progress->start(tiles.jobs.size());
  counts.phases.transform = prepare_draws(screen, list, shader, options.cull_single_sided, scratch);

  const auto clusters = static_cast<std::uint32_t>(list.clusters.size());
  const std::uint32_t bins = (clusters + kBinClusters - 1) / kBinClusters;
  if (scratch.bins.size() < bins) scratch.bins.resize(bins);
  ProcessorSeconds bin_seconds;
  parallel::parallel_for(0, bins, 1, [&](std::size_t k) {
    bin_seconds.measure([&] {
      const auto begin = static_cast<std::uint32_t>(k) * kBinClusters;
      fill_bin(screen, list, scratch.draws, begin, std::min(begin + kBinClusters, clusters),
               tiles.wanted, scratch.bins[k]);
    });
    if (progress != nullptr) progress->advance(0);
  });
  for (std::uint32_t k = 0; k < bins; ++k) counts.triangles += scratch.bins[k].counts;
  counts.phases.bin = bin_seconds.seconds();

  const FrameShading frame = make_frame_shading(screen, shader, list, options.lighting);
  const std::span<const Bin> filled(scratch.bins.data(), bins);
  ProcessorSeconds rasterize_seconds, shade_seconds;
  std::atomic<std::uint64_t> fragments{0};
  parallel::parallel_for(0, tiles.jobs.size(), 1, [&](std::size_t k) {
    static thread_local VisibilityTile tile;
    static thread_local SeenTriangles seen;
    const TileJob& job = tiles.jobs[k];
    const std::span rects = std::span(tiles.rects).subspan(job.first, job.last - job.first);
    const geometry::Rect rect = hull(rects);
    if (std::none_of(filled.begin(), filled.end(),
                     [&](const Bin& bin) { return !bin.of_tile(job.tile).empty(); })) {
      for (const geometry::Rect& r : rects) clear_pixels(r, image);
      if (progress != nullptr) progress->advance();
      return;
    }
    seen.clear();
    rasterize_seconds.measure([&] {
      tile.clear(rect);
      const auto is_solid = [&](std::uint32_t number, int x, int y) {
        return solid(frame, seen, number, x, y);
      };
      for (const Bin& bin : filled) {
        const std::span<const std::uint32_t> entries = bin.of_tile(job.tile);
        if (entries.empty()) continue;
        rasterize(screen, rect, bin.triangles, entries, tile);
        rasterize_masked(screen, rect, bin.triangles, entries, is_solid, tile);
      }
    });
    shade_seconds.measure([&] {
      std::uint64_t shaded = 0;
      for (const geometry::Rect& r : rects) shaded += shade_tile(frame, seen, tile, r, image);
      fragments.fetch_add(shaded, std::memory_order_relaxed);
    });
    if (progress != nullptr) progress->advance();
  });
  counts.phases.rasterize = rasterize_seconds.seconds();
  counts.phases.shade = shade_seconds.seconds();
  counts.fragments = fragments;
  counts.tiles = tiles.jobs.size();
  return counts;
}

template RegionCounts render_regions(const Screen&, const DrawList&, const shading::Shader&,
                                     const RenderOptions&, std::span<const geometry::Rect>,
                                     Scratch&, image::Image8&, parallel::Progress*);
template RegionCounts render_regions(const Screen&, const DrawList&, const shading::Shader&,
                                     const RenderOptions&, std::span<const geometry::Rect>,
                                     Scratch&, image::ImageF&, parallel::Progress*);

}  // namespace delray::raster
