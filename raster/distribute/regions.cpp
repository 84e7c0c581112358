// Draws a list into regions of the frame and finishes their tiles: clusters first, then, tile by
// tile and in parallel, triangles that touch many tiles, blended ones, and whatever the caller
// makes of the tile.
//
// Threads take tiles in order from a counter. Each has a worker's memory, which forgets its
// triangles when the next drawing begins. Degenerate: tiles in which nothing is drawn have no
// visibility memory; the caller sees an empty view.
#include "raster/distribute/regions.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <mutex>
#include <numeric>
#include <utility>

#include "parallel/parallel_for.h"
#include "raster/pipeline/processor_seconds.h"

namespace delray::raster {
namespace {

// Samples are every eighth pixel of every eighth row of a tile, from this one of the row on: in
// each such row others than in the one before.
constexpr int kSampleStep = 8;
int sample_column(int y) { return y / kSampleStep * 5 % kSampleStep; }
// The first from `at` on that is so many after a multiple of the step.
int next_sample(int at, int after) {
  return at + (after - at % kSampleStep + kSampleStep) % kSampleStep;
}
bool is_sample(int x, int y) { return y % kSampleStep == 0 && x % kSampleStep == sample_column(y); }

}  // namespace

void RegionCounts::operator+=(const RegionCounts& other) {
  phases += other.phases;
  triangles += other.triangles;
  fragments += other.fragments;
  shaded += other.shaded;
  tiles += other.tiles;
}

PreparedFrame::PreparedFrame(const RegionTask& task)
    : shading_(make_frame_shading(task.screen, task.shader, task.list, task.options.lighting,
                                  task.distances)) {
  add_draws(task);
}

void PreparedFrame::add_draws(const RegionTask& task) {
  const std::vector<Draw>& draws = task.list.draws;
  for (std::size_t i = 0; i < draws_.size(); ++i) draws_[i].draw = &draws[i];
  constexpr std::size_t kAtOnce = 256;
  const std::size_t first = draws_.size();
  draws_.resize(draws.size());
  parallel::parallel_for(first, draws.size(), kAtOnce, [&](std::size_t i) {
    draws_[i] = prepare_draw(task.screen, draws[i], task.shader, task.options.cull_single_sided);
  });
  raster::add_draws(shading_);
}

RegionDrawing::RegionDrawing(const RegionTask& task, Scratch& scratch)
    : RegionDrawing(task, std::make_unique<PreparedFrame>(task), nullptr, scratch) {}

RegionDrawing::RegionDrawing(const RegionTask& task, const PreparedFrame& frame, Scratch& scratch)
    : RegionDrawing(task, nullptr, &frame, scratch) {}

RegionDrawing::RegionDrawing(const RegionTask& task, std::unique_ptr<PreparedFrame> own,
                             const PreparedFrame* frame, Scratch& scratch)
    : task_(task),
      scratch_(scratch),
      tiles_(make_tile_jobs(task.screen, task.regions)),
      own_frame_(std::move(own)),
      frame_(own_frame_ != nullptr ? own_frame_.get() : frame),
      holder_(task.list.holder != nullptr && !task.list.holder->keeps_all() ? task.list.holder
                                                                            : nullptr),
      into_tiles_{task.screen,
                  task.list,
                  frame_->draws(),
                  tiles_.clip,
                  task.options.skip_hidden_clusters,
                  [this](std::size_t worker, std::uint32_t number, int x, int y) {
                    return alpha_test(frame_->shading(), scratch_.tile_memory[worker]->seen, number,
                                      x, y);
                  },
                  {},
                  {},
                  task.progress} {
  const Screen& screen = task.screen;
  if (task.progress != nullptr) task.progress->start(tiles_.jobs.size());
  scratch_.tiles.begin(screen, tiles_);
  begin_drawing(screen, scratch_.workers);
  while (scratch_.tile_memory.size() < scratch_.workers.size())
    scratch_.tile_memory.push_back(std::make_unique<TileMemory>());
  // The triangles of another drawing have the same numbers.
  for (const auto& memory : scratch_.tile_memory) {
    memory->seen.clear();
    memory->seen_in.clear();
  }
  if (holder_ != nullptr && task.options.shade == Shade::deferred && frame_->shading().all_plain) {
    // What they are of need not come back to memory when tiles are finished.
    holder_->need_not_keep();
    const std::uint64_t number = ++scratch_.coloured;
    scratch_.tile_colours.resize(static_cast<std::size_t>(screen.tiles()));
    into_tiles_.tile_drawn = [this, number](int tile, VisibilityTile& visibility) {
      std::unique_ptr<TileColours>& colours = scratch_.tile_colours[static_cast<std::size_t>(tile)];
      if (colours == nullptr) colours.reset(new TileColours);
      look_up_colours(frame_->shading(), visibility, number, *colours);
    };
  }
  if (task.options.shade != Shade::immediate) return;
  const auto pixels =
      static_cast<std::size_t>(screen.width) * static_cast<std::size_t>(screen.height);
  if (scratch_.shaded.size() < pixels) scratch_.shaded = image::Plane<image::RgbaF>(pixels);
  into_tiles_.shade_now = [this](std::size_t worker, std::uint32_t number, int x, int y) {
    scratch_.shaded[static_cast<std::size_t>(y) * static_cast<std::size_t>(task_.screen.width) +
                    static_cast<std::size_t>(x)] =
        colour_at(frame_->shading(), scratch_.tile_memory[worker]->seen, number, x, y);
  };
}

std::vector<std::uint32_t> RegionDrawing::nearest_first(
    std::span<const std::uint32_t> clusters) const {
  return raster::nearest_first(into_tiles_, clusters);
}

void RegionDrawing::draw(std::span<const std::uint32_t> clusters) {
  if (own_frame_ != nullptr) {
    own_frame_->add_draws(task_);
    into_tiles_.draws = own_frame_->draws();
  }
  draw_in_order(nearest_first(clusters));
}

void RegionDrawing::draw_in_order(std::span<const std::uint32_t> clusters) {
  draw_clusters(into_tiles_, clusters, scratch_.tiles, scratch_.workers, costs_);
}

void RegionDrawing::draw_all() {
  std::vector<std::uint32_t> clusters(task_.list.clusters.size());
  std::iota(clusters.begin(), clusters.end(), 0U);
  draw(clusters);
}

bool RegionDrawing::hides(const geometry::Rect& samples, float depth) const {
  const geometry::Rect wanted = geometry::intersection(samples, tiles_.clip);
  if (wanted.empty()) return true;
  return task_.options.skip_hidden_clusters && scratch_.tiles.is_hidden(wanted, depth);
}

geometry::Rect RegionDrawing::tiles_seen() const {
  const int columns = task_.screen.tiles_x;
  geometry::Rect seen{columns, task_.screen.tiles_y, 0, 0};
  const auto include = [&](int tile) {
    const int x = tile % columns, y = tile / columns;
    seen = {std::min(seen.x0, x), std::min(seen.y0, y), std::max(seen.x1, x + 1),
            std::max(seen.y1, y + 1)};
  };
  for (const TileJob& job : tiles_.jobs)
    if (scratch_.tiles.is_drawn_in(job.tile)) include(job.tile);
  for (const auto& worker : scratch_.workers) {
    for (const auto* entries : {&worker->result.large_entries, &worker->result.blended_entries}) {
      for (const SetUpResult::Entry& entry : *entries) include(static_cast<int>(entry.tile));
    }
  }
  return seen;
}

RegionCounts RegionDrawing::finish(FinishTile finish_tile) {
  if (finished_ == 0) end_drawing();
  finish_jobs(std::span(tiles_.jobs).subspan(finished_), finish_tile);
  return std::exchange(counts_, {});
}

std::span<const TileJob> RegionDrawing::finish_some(FinishTile finish_tile,
                                                    parallel::FunctionRef<bool(int)> wanted,
                                                    parallel::FunctionRef<bool()> more) {
  assert(finished_ == 0);
  const auto middle = std::stable_partition(tiles_.jobs.begin(), tiles_.jobs.end(),
                                            [&](const TileJob& job) { return wanted(job.tile); });
  const auto most = static_cast<std::size_t>(middle - tiles_.jobs.begin());
  const std::size_t at_a_time = 2 * scratch_.workers.size();
  while (finished_ < most && more()) {
    if (finished_ == 0) end_drawing();
    const std::size_t end = std::min(finished_ + at_a_time, most);
    finish_jobs(std::span(tiles_.jobs).subspan(finished_, end - finished_), finish_tile);
    finished_ = end;
  }
  return std::span(tiles_.jobs).first(finished_);
}

void RegionDrawing::finish_rows(int first, int rows, FinishTile finish_tile,
                                RowsFinished rows_finished) {
  const Screen& screen = task_.screen;
  assert(0 <= first && first < screen.tiles_y && rows >= 1);
  end_drawing();
  const auto job_at = [&](int row) {
    return std::partition_point(tiles_.jobs.begin(), tiles_.jobs.end(), [&](const TileJob& job) {
      return job.tile < row * screen.tiles_x;
    });
  };
  const auto finish_between = [&](int from, int to) {
    for (int begin = from; begin < to; begin += rows) {
      const int end = std::min(begin + rows, to);
      finish_jobs(std::span(job_at(begin), job_at(end)), finish_tile);
      rows_finished(begin, end, std::exchange(counts_, {}));
    }
  };
  finish_between(first, screen.tiles_y);
  finish_between(0, first);
}

void RegionDrawing::end_drawing() {
  counts_.triangles =
      raster::end_drawing(task_.screen, scratch_.workers, scratch_.deferred, costs_);
  counts_.phases.transform = costs_.set_up;
  counts_.phases.bin = costs_.sort;
  counts_.phases.rasterize = costs_.rasterize;
  counts_.shaded = costs_.shaded;
}

std::array<BlockCover, VisibilityTile::kBlocks> RegionDrawing::hidden_behind(int tile) const {
  std::array<BlockCover, VisibilityTile::kBlocks> result;
  const std::size_t first = static_cast<std::size_t>(tile) * result.size();
  // The covers do not know of large triangles.
  const bool is_known = scratch_.deferred.large.of_tile(tile).empty();
  for (std::size_t block = 0; block < result.size(); ++block) {
    const BlockCover& others = hidden_behind_[first + block];
    if (others.may_hide(is_known ? covers_[first + block].farthest : kEmptyCode))
      result[block] = others;
  }
  return result;
}

void RegionDrawing::drop_hidden(int tile, VisibilityTile& visibility) {
  if (hidden_behind_.empty()) return;
  const auto covers = hidden_behind(tile);
  bool any = false;
  for (std::size_t block = 0; block < covers.size(); ++block)
    any |= raster::drop_hidden(covers[block], static_cast<int>(block), visibility);
  scratch_.partly_hidden[static_cast<std::size_t>(tile)] = any ? 1 : 0;
}

ShadedPixels RegionDrawing::shaded_pixels(int tile) const {
  if (looks_up_colours()) {
    const TileColours* const colours = scratch_.tile_colours[static_cast<std::size_t>(tile)].get();
    return {colours == nullptr ? nullptr : colours->colour, kTileSize};
  }
  if (task_.options.shade != Shade::immediate) return {};
  const geometry::Rect corner = task_.screen.tile(tile);
  const std::ptrdiff_t stride = task_.screen.width;
  return {scratch_.shaded.data() + corner.y0 * stride + corner.x0, stride};
}

// The draws of large triangles that are looked up while they are drawn.
void RegionDrawing::find_large(int tile, std::vector<std::uint32_t>& draws) const {
  draws.clear();
  BinnedTriangles& large = scratch_.deferred.large;
  for (const std::uint32_t entry : large.of_tile(tile)) {
    if ((entry & kMasked) != 0 || into_tiles_.shade_now)
      draws.push_back(task_.list.cluster_of(large.triangles[entry & kIndex].number).draw);
  }
}

// The draws of all that is seen in the tile, or through it.
void RegionDrawing::find_seen(const TileJob& job, const VisibilityTile* tile, TileMemory& memory,
                              std::vector<std::uint32_t>& draws) const {
  draws.clear();
  memory.seen_in.resize(task_.list.draws.size(), -1);
  std::uint32_t last = kNothing;
  const auto add = [&](std::uint32_t number) {
    if (number == kNothing || number >> kClusterBits == last) return;
    last = number >> kClusterBits;
    const std::uint32_t draw = task_.list.clusters[last].draw;
    if (std::exchange(memory.seen_in[draw], job.tile) != job.tile) draws.push_back(draw);
  };
  for (const geometry::Rect& rect : tiles_.rects_of(job)) {
    for (int y = rect.y0; y < rect.y1 && tile != nullptr; ++y) {
      for (int x = rect.x0; x < rect.x1; ++x)
        add(number_of(tile->key[y % kTileSize * kTileSize + x % kTileSize]));
    }
  }
  for (const BlendedFragment& fragment : memory.blended) add(number_of(fragment.key));
}

void RegionDrawing::sample_seen() {
  samples_seen_ = true;
  scratch_.seen.clear();
  scratch_.seen_at.clear();
}

void RegionDrawing::drop_samples(parallel::FunctionRef<bool(std::uint64_t pixel)> drops) {
  if (!samples_seen_) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < scratch_.seen.size(); ++i) {
    if (drops(scratch_.seen_at[i])) continue;
    scratch_.seen[kept] = scratch_.seen[i];
    scratch_.seen_at[kept++] = scratch_.seen_at[i];
  }
  scratch_.seen.resize(kept);
  scratch_.seen_at.resize(kept);
}

void RegionDrawing::sample_seen(const TileJob& job, const VisibilityTile* tile,
                                std::span<const BlendedFragment> blended,
                                std::vector<std::uint32_t>& numbers,
                                std::vector<std::uint64_t>& at) const {
  const geometry::Rect corner = task_.screen.tile(job.tile);
  const auto add = [&](std::int64_t key, int x, int y) {
    const std::uint32_t number = number_of(key);
    if (!is_sample(x, y) || number == kNothing) return;
    numbers.push_back(number);
    at.push_back(static_cast<std::uint64_t>(corner.y0 + y) *
                     static_cast<std::uint64_t>(task_.screen.width) +
                 static_cast<std::uint64_t>(corner.x0 + x));
  };
  for (const BlendedFragment& fragment : blended) {
    const auto pixel = static_cast<int>(fragment.pixel);
    add(fragment.key, pixel % kTileSize, pixel / kTileSize);
  }
  if (tile == nullptr) return;
  for (const geometry::Rect& rect : tiles_.rects_of(job)) {
    for (int y = next_sample(rect.y0 - corner.y0, 0); y < rect.y1 - corner.y0; y += kSampleStep) {
      for (int x = next_sample(rect.x0 - corner.x0, sample_column(y)); x < rect.x1 - corner.x0;
           x += kSampleStep)
        add(tile->key[y * kTileSize + x], x, y);
    }
  }
}

void RegionDrawing::finish_jobs(std::span<const TileJob> jobs, FinishTile finish_tile) {
  const Screen& screen = task_.screen;
  ProcessorSeconds rasterize_seconds, shade_seconds;
  std::atomic<std::uint64_t> fragments{0}, shaded{0};
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  parallel::parallel_for(0, scratch_.workers.size(), 1, [&](std::size_t worker) {
    StageClock<2> clock;
    std::vector<std::uint32_t> seen;
    std::vector<std::uint64_t> seen_at;
    TileMemory& mine = *scratch_.tile_memory[worker];
    std::vector<std::uint32_t> draws;
    std::uint64_t shaded_here = 0, shown_here = 0;
    for (;;) {
      const std::size_t k = next.fetch_add(1, std::memory_order_relaxed);
      if (k >= jobs.size()) break;
      const int index = jobs[k].tile;
      VisibilityTile* tile = nullptr;
      if (scratch_.tiles.is_drawn_in(index)) {
        tile = &scratch_.tiles.open(index);
      } else if (!scratch_.deferred.large.of_tile(index).empty()) {
        // In memory that stays in the cache.
        tile = &mine.visibility;
        tile->clear(scratch_.tiles.rect(index));
      }
      if (tile != nullptr) {
        if (holder_ != nullptr) find_large(index, draws);
        const HeldDraws held(holder_, draws);
        shaded_here += draw_large(into_tiles_, worker, scratch_.deferred.large,
                                  {index, scratch_.tiles.rect(index), *tile});
      }
      if (tile != nullptr) drop_hidden(index, *tile);
      find_blended(screen, scratch_.tiles.rect(index), scratch_.deferred.blended.triangles,
                   scratch_.deferred.blended.of_tile(index), tile, mine.blended);
      if (samples_seen_) sample_seen(jobs[k], tile, mine.blended, seen, seen_at);
      clock.finish(0);
      TileView view(frame_->shading(), tile, shaded_pixels(index), mine);
      draws.clear();
      if (holder_ != nullptr && !looks_up_colours()) find_seen(jobs[k], tile, mine, draws);
      {
        const HeldDraws held(holder_, draws);
        finish_tile(tiles_.rects_of(jobs[k]), view);
      }
      clock.finish(1);
      shown_here += view.shown();
      shaded_here += looks_up_colours() ? view.shown() : view.shaded();
      if (task_.progress != nullptr) task_.progress->advance();
    }
    fragments.fetch_add(shown_here, std::memory_order_relaxed);
    shaded.fetch_add(shaded_here, std::memory_order_relaxed);
    clock.add_to({&rasterize_seconds, &shade_seconds});
    if (seen.empty()) return;
    const std::lock_guard lock(mutex);
    scratch_.seen.insert(scratch_.seen.end(), seen.begin(), seen.end());
    scratch_.seen_at.insert(scratch_.seen_at.end(), seen_at.begin(), seen_at.end());
  });
  counts_.phases.rasterize += rasterize_seconds.seconds();
  counts_.phases.shade += shade_seconds.seconds();
  counts_.fragments += fragments;
  counts_.shaded += shaded;
  counts_.tiles += jobs.size();
}

}  // namespace delray::raster
