// Draws clusters into tiles in batches, so that triangles that are set up never leave the cache.
//
// A thread takes the next batch of clusters, culls, transforms and sets them up, sorts the
// fragments, windows and triangles by tile by counting, then draws them into each tile that it can
// lock; tiles of other threads come later. Clusters come nearest draws first, so that the farthest
// depths of blocks hide what follows. Large and blended triangles wait for the end.
//
// Degenerate: a frame of one cluster is one batch; tiles that nobody wants are skipped.
#include "raster/pipeline/draw_into_tiles.h"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <thread>
#include <utility>

#include "parallel/arena.h"
#include "parallel/parallel_for.h"
#include "raster/pipeline/cull.h"
#include "raster/pipeline/processor_seconds.h"
#include "raster/pipeline/splat_set_up.h"

namespace delray::raster {
namespace {

// Clusters set up before their pixels are drawn: enough that a tile is opened for many pixels at a
// time, few enough that they stay in the cache.
constexpr std::size_t kBatchClusters = 32;
// Batches per thread at least, for balance.
constexpr std::size_t kLeastBatches = 16;

void set_up_one(const DrawIntoTiles& task, std::uint32_t k, const FrameTiles& tiles,
                Worker& worker) {
  const Cluster& cluster = task.list.clusters[k];
  const PreparedDraw& draw = task.draws[cluster.draw];
  const ClusterBlock& block = task.list.block_of(cluster);
  const MeshCluster& mesh_cluster = block.clusters[cluster.part];
  const std::uint64_t triangles = cluster.end - cluster.begin;
  TriangleCounts& counts = worker.result.counts;

  const ClusterBounds bounds = bound(task.screen, draw, mesh_cluster.box);
  const geometry::Rect pixels = geometry::intersection(bounds.pixels, task.clip);
  if (bounds.outside || pixels.empty() ||
      shows_hidden_side_only(task.screen, draw, mesh_cluster, bounds)) {
    counts.in += triangles;
    counts.culled += triangles;
    return;
  }
  if (task.skip_hidden_clusters && tiles.is_hidden(pixels, bounds.nearest)) {
    counts.in += triangles;
    counts.hidden += triangles;
    ++counts.hidden_clusters;
    return;
  }
  const ClusterToSetUp to_set_up{{task.screen, draw, block, mesh_cluster, worker.vertices},
                                 cluster.begin,
                                 cluster.end,
                                 k << kClusterBits,
                                 task.clip};
  if (draw.splats.any()) {
    set_up_splats(to_set_up, worker.vertices, worker.result);
    return;
  }
  transform(draw.to_view, task.screen, draw.draw->mesh->positions, block.vertices_of(mesh_cluster),
            worker.vertices);
  set_up_cluster(to_set_up, tiles, worker.result);
}

// By counting, into worker.fragments, entries and windows. Neighbours in a batch lie in one tile or
// the next at random: there are no branches on tiles.
void sort_by_tile(Worker& worker) {
  const SetUpResult& result = worker.result;
  const std::span addresses(result.address.data(), result.fragments);
  const std::span window_tiles(result.windows.tile.data(), result.windows.size);
  const std::span spot_tiles(result.spots.tile.data(), result.spots.size);
  std::uint32_t low = kNothing, high = 0;
  const auto touch = [&](std::uint32_t tile) {
    low = std::min(low, tile);
    high = std::max(high, tile);
    return tile;
  };
  Worker::TileCounts* const counts = worker.counts.data();
  for (const std::uint32_t address : addresses) ++counts[touch(address / kTilePixels)].fragments;
  for (const SetUpResult::Entry& entry : result.entries) ++counts[touch(entry.tile)].entries;
  for (const std::uint32_t tile : window_tiles) ++counts[touch(tile)].windows;
  for (const std::uint32_t tile : spot_tiles) ++counts[touch(tile)].spots;
  for (const SetUpResult::Entry& entry : result.splat_entries) ++counts[touch(entry.tile)].splats;

  worker.touched.clear();
  Worker::TileCounts next;
  for (std::uint32_t tile = low; tile <= high && low != kNothing; ++tile) {
    const Worker::TileCounts here = counts[tile];
    if ((here.fragments | here.entries | here.windows | here.spots | here.splats) == 0) continue;
    counts[tile] = next;
    const Worker::TileCounts first = next;
    next = {first.fragments + here.fragments, first.entries + here.entries,
            first.windows + here.windows, first.spots + here.spots, first.splats + here.splats};
    worker.touched.push_back({tile, first.fragments, next.fragments, first.entries, next.entries,
                              first.windows, next.windows, first.spots, next.spots, first.splats,
                              next.splats});
  }

  if (worker.fragments.size() < next.fragments) worker.fragments.resize(next.fragments);
  Fragment* const sorted = worker.fragments.data();
  for (std::size_t i = 0; i < addresses.size(); ++i) {
    const std::uint32_t address = addresses[i];
    sorted[counts[address / kTilePixels].fragments++] = {
        static_cast<std::int64_t>(std::uint64_t{result.code[i]} << 32 | result.number[i]),
        address % kTilePixels};
  }
  if (worker.entries.size() < next.entries) worker.entries.resize(next.entries);
  for (const SetUpResult::Entry& entry : result.entries)
    worker.entries[counts[entry.tile].entries++] = entry.entry;
  if (worker.windows.size() < next.windows) worker.windows.resize(next.windows);
  for (std::uint32_t k = 0; k < window_tiles.size(); ++k)
    worker.windows[counts[window_tiles[k]].windows++] = k;
  if (worker.spots.size() < next.spots) worker.spots.resize(next.spots);
  for (std::uint32_t k = 0; k < spot_tiles.size(); ++k)
    worker.spots[counts[spot_tiles[k]].spots++] = k;
  if (worker.splats.size() < next.splats) worker.splats.resize(next.splats);
  for (const SetUpResult::Entry& entry : result.splat_entries)
    worker.splats[counts[entry.tile].splats++] = entry.entry;
  for (const Worker::TouchedTile& touched : worker.touched) counts[touched.tile] = {};
}

// The callbacks of a drawing as those of one worker.
auto alpha_test_of(const DrawIntoTiles& task, std::size_t worker) {
  return [&task, worker](std::uint32_t number, int x, int y) {
    return task.alpha_test(worker, number, x, y);
  };
}
auto shade_now_of(const DrawIntoTiles& task, std::size_t worker) {
  return
      [&task, worker](std::uint32_t number, int x, int y) { task.shade_now(worker, number, x, y); };
}

void draw_into(const DrawIntoTiles& task, const Worker::TouchedTile& touched, Worker& worker,
               FrameTiles& tiles) {
  const auto index = static_cast<int>(touched.tile);
  VisibilityTile& tile = tiles.open(index);
  const geometry::Rect& rect = tiles.rect(index);
  const auto fragments =
      std::span(worker.fragments)
          .subspan(touched.first_fragment, touched.last_fragment - touched.first_fragment);
  const auto entries = std::span(worker.entries)
                           .subspan(touched.first_entry, touched.last_entry - touched.first_entry);
  const auto splats = std::span(worker.splats)
                          .subspan(touched.first_splat, touched.last_splat - touched.first_splat);
  const auto alpha_test = alpha_test_of(task, worker.index);
  if (task.shade_now) {
    const auto shade_now = shade_now_of(task, worker.index);
    worker.shaded += draw_and_shade(fragments, rect, shade_now, tile);
    worker.shaded +=
        draw_and_shade(task.screen, rect, worker.result.splats, splats, shade_now, tile);
    worker.shaded += draw_and_shade(task.screen, rect, worker.result.triangles, entries, alpha_test,
                                    shade_now, tile);
    return;
  }
  rasterize_windows(worker.result.windows,
                    std::span(worker.windows)
                        .subspan(touched.first_window, touched.last_window - touched.first_window),
                    tile);
  rasterize_spots(
      worker.result.spots,
      std::span(worker.spots).subspan(touched.first_spot, touched.last_spot - touched.first_spot),
      tile);
  rasterize_fragments(fragments, tile);
  rasterize_splats(task.screen, rect, worker.result.splats, splats, tile);
  if (entries.empty()) return;
  rasterize(task.screen, rect, worker.result.triangles, entries, tile);
  rasterize_masked(task.screen, rect, worker.result.triangles, entries, alpha_test, tile);
}

// Others wait for it, also where this thread throws.
struct LockedTile {
  FrameTiles& tiles;
  const int number;
  ~LockedTile() { tiles.unlock(number); }
};

// Tiles that another thread has at the moment come later.
void draw_touched(const DrawIntoTiles& task, Worker& worker, FrameTiles& tiles) {
  std::erase_if(worker.touched, [&](const Worker::TouchedTile& touched) {
    return !tiles.is_wanted(static_cast<int>(touched.tile));
  });
  while (!worker.touched.empty()) {
    const std::size_t before = worker.touched.size();
    std::erase_if(worker.touched, [&](const Worker::TouchedTile& touched) {
      const auto tile = static_cast<int>(touched.tile);
      if (!tiles.try_lock(tile)) return false;
      const LockedTile locked{tiles, tile};
      draw_into(task, touched, worker, tiles);
      if (task.tile_drawn) task.tile_drawn(tile, tiles.open(tile));
      return true;
    });
    if (worker.touched.size() == before) std::this_thread::yield();
  }
}

glm::vec3 eye_in_mesh(const ToView& to_view) {
  const glm::vec4* row = to_view.row;
  const glm::dmat3 axes =
      glm::transpose(glm::dmat3(glm::dvec3(row[0]), glm::dvec3(row[1]), glm::dvec3(row[2])));
  return -(glm::inverse(axes) * glm::dvec3(row[0].w, row[1].w, row[2].w));
}

// The entries of one triangle, which lie together.
struct Run {
  float nearest;
  std::uint32_t worker, first, last;
};
float nearest_depth(const ScreenTriangle& triangle) {
  const ScreenVertex* v = triangle.vertex;
  return std::min({v[0].depth, v[1].depth, v[2].depth});
}

// The entries of a tile are those of near triangles first.
void bin(const Screen& screen, std::span<const std::unique_ptr<Worker>> workers,
         std::vector<ScreenTriangle> SetUpResult::*triangles,
         std::vector<SetUpResult::Entry> SetUpResult::*entries, BinnedTriangles& bins) {
  bins.triangles.clear();
  bins.first.clear();
  bins.entries.clear();
  std::vector<Run> runs;
  std::vector<std::uint32_t> offset;
  std::size_t count = 0;
  for (std::uint32_t k = 0; k < workers.size(); ++k) {
    const std::vector<ScreenTriangle>& from = workers[k]->result.*triangles;
    const std::vector<SetUpResult::Entry>& all = workers[k]->result.*entries;
    offset.push_back(static_cast<std::uint32_t>(bins.triangles.size()));
    bins.triangles.insert(bins.triangles.end(), from.begin(), from.end());
    count += all.size();
    for (std::uint32_t i = 0; i < all.size(); ++i) {
      if (i == 0 || all[i].entry != all[i - 1].entry)
        runs.push_back({nearest_depth(from[all[i].entry & kIndex]), k, i, i});
      runs.back().last = i + 1;
    }
  }
  if (count == 0) return;
  std::stable_sort(runs.begin(), runs.end(),
                   [](const Run& a, const Run& b) { return a.nearest < b.nearest; });
  bins.first.assign(static_cast<std::size_t>(screen.tiles()) + 1, 0);
  for (const auto& worker : workers)
    for (const SetUpResult::Entry& entry : worker->result.*entries) ++bins.first[entry.tile + 1];
  std::partial_sum(bins.first.begin(), bins.first.end(), bins.first.begin());
  std::vector<std::uint32_t> next(bins.first.begin(), bins.first.end() - 1);
  bins.entries.resize(count);
  for (const Run& run : runs) {
    const std::vector<SetUpResult::Entry>& all = workers[run.worker]->result.*entries;
    for (std::uint32_t i = run.first; i < run.last; ++i)
      bins.entries[next[all[i].tile]++] = all[i].entry + offset[run.worker];
  }
}

}  // namespace

std::vector<std::uint32_t> nearest_first(const DrawIntoTiles& task,
                                         std::span<const std::uint32_t> clusters) {
  const DrawList& list = task.list;
  // The slots of a draw: clusters that face the eye, then those that turn away from it, which the
  // former often hide.
  std::vector<std::uint32_t> count(2 * list.draws.size());
  std::vector<glm::vec3> eye(list.draws.size());
  for (std::size_t i = 0; i < eye.size(); ++i) eye[i] = eye_in_mesh(task.draws[i].to_view);
  std::vector<std::uint32_t> slot(clusters.size());
  constexpr std::size_t kGrain = 4096;
  parallel::parallel_for(0, clusters.size(), kGrain, [&](std::size_t i) {
    const Cluster& cluster = list.clusters[clusters[i]];
    const MeshCluster& part = list.block_of(cluster).clusters[cluster.part];
    const bool away =
        part.cosine > 0 && glm::dot(part.box.centre() - eye[cluster.draw], part.axis) > 0;
    slot[i] = 2 * cluster.draw + (away ? 1 : 0);
  });
  for (const std::uint32_t s : slot) ++count[s];

  // By counting: the order of clusters within a slot stays.
  std::vector<std::uint32_t> draws;
  std::vector<float> distance(list.draws.size());
  for (std::uint32_t i = 0; i < distance.size(); ++i) {
    if (count[2 * i] + count[2 * i + 1] == 0) continue;
    draws.push_back(i);
    if (list.draws.size() == 1) break;
    geometry::Box3 box;
    for (const auto& block : list.draws[i].clusters->blocks)
      if (block != nullptr) box.include(block->box);
    const ClusterBounds bounds = bound(task.screen, task.draws[i], box);
    distance[i] = bounds.nearest;  // ascends with distance
  }
  std::stable_sort(draws.begin(), draws.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return distance[a] < distance[b]; });
  std::vector<std::uint32_t>& next = count;
  std::uint32_t first = 0;
  for (const std::uint32_t draw : draws)
    for (const std::uint32_t s : {2 * draw, 2 * draw + 1}) first += std::exchange(next[s], first);
  std::vector<std::uint32_t> order(clusters.size());
  for (std::size_t i = 0; i < clusters.size(); ++i) order[next[slot[i]]++] = clusters[i];
  return order;
}

void begin_drawing(const Screen& screen, std::vector<std::unique_ptr<Worker>>& workers) {
  const auto threads = static_cast<std::size_t>(parallel::arena_threads());
  while (workers.size() < threads) {
    workers.push_back(std::make_unique<Worker>());
    workers.back()->index = workers.size() - 1;
  }
  for (const auto& worker : workers) {
    worker->result.clear();
    worker->result.large_triangles.clear();
    worker->result.large_entries.clear();
    worker->result.blended_triangles.clear();
    worker->result.blended_entries.clear();
    worker->result.counts = {};
    worker->shaded = 0;
    worker->counts.assign(static_cast<std::size_t>(screen.tiles()), {});
  }
}

void draw_clusters(const DrawIntoTiles& task, std::span<const std::uint32_t> clusters,
                   FrameTiles& tiles, std::span<const std::unique_ptr<Worker>> workers,
                   DrawCosts& costs) {
  const std::size_t threads =
      std::min(workers.size(), static_cast<std::size_t>(parallel::arena_threads()));
  const std::size_t batch =
      std::clamp<std::size_t>(clusters.size() / (threads * kLeastBatches), 1, kBatchClusters);
  // Batches are taken in order, so that what is near is drawn early.
  std::atomic<std::size_t> next{0};
  ProcessorSeconds set_up_seconds, sort_seconds, rasterize_seconds;
  parallel::parallel_for(0, threads, 1, [&](std::size_t thread) {
    Worker& worker = *workers[thread];
    StageClock<3> clock;
    for (;;) {
      const std::size_t begin = next.fetch_add(batch, std::memory_order_relaxed);
      if (begin >= clusters.size()) break;
      worker.result.clear();
      worker.result.fragments_only = task.shade_now != nullptr;
      const std::span mine = clusters.subspan(begin, std::min(batch, clusters.size() - begin));
      worker.draws.clear();
      for (const std::uint32_t cluster : mine)
        worker.draws.push_back(task.list.clusters[cluster].draw);
      const HeldDraws held(task.list.holder, worker.draws);
      for (const std::uint32_t cluster : mine) set_up_one(task, cluster, tiles, worker);
      clock.finish(0);
      sort_by_tile(worker);
      clock.finish(1);
      draw_touched(task, worker, tiles);
      clock.finish(2);
      if (task.progress != nullptr) task.progress->advance(0);
    }
    clock.add_to({&set_up_seconds, &sort_seconds, &rasterize_seconds});
  });
  costs.set_up += set_up_seconds.seconds();
  costs.sort += sort_seconds.seconds();
  costs.rasterize += rasterize_seconds.seconds();
}

TriangleCounts end_drawing(const Screen& screen, std::span<const std::unique_ptr<Worker>> workers,
                           DeferredTriangles& deferred, DrawCosts& costs) {
  bin(screen, workers, &SetUpResult::large_triangles, &SetUpResult::large_entries, deferred.large);
  bin(screen, workers, &SetUpResult::blended_triangles, &SetUpResult::blended_entries,
      deferred.blended);
  TriangleCounts counts;
  for (const auto& worker : workers) {
    counts += worker->result.counts;
    costs.shaded += worker->shaded;
  }
  return counts;
}

TriangleCounts draw_into_tiles(const DrawIntoTiles& task, FrameTiles& tiles,
                               std::vector<std::unique_ptr<Worker>>& workers,
                               DeferredTriangles& deferred, DrawCosts& costs) {
  begin_drawing(task.screen, workers);
  std::vector<std::uint32_t> clusters(task.list.clusters.size());
  std::iota(clusters.begin(), clusters.end(), 0U);
  draw_clusters(task, nearest_first(task, clusters), tiles, workers, costs);
  return end_drawing(task.screen, workers, deferred, costs);
}

std::uint64_t draw_large(const DrawIntoTiles& task, std::size_t worker, BinnedTriangles& large,
                         const OwnTile& tile) {
  const std::span<const std::uint32_t> entries = large.of_tile(tile.number);
  if (entries.empty()) return 0;
  const auto alpha_test = alpha_test_of(task, worker);
  if (task.shade_now) {
    return draw_and_shade(task.screen, tile.rect, large.triangles, entries, alpha_test,
                          shade_now_of(task, worker), tile.visibility);
  }
  rasterize(task.screen, tile.rect, large.triangles, entries, tile.visibility);
  rasterize_masked(task.screen, tile.rect, large.triangles, entries, alpha_test, tile.visibility);
  return 0;
}

}  // namespace delray::raster
