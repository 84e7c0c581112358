// Sort-first with a schedule: ranks begin with the blocks of their regions, or with none, and get
// others while they render. All have the primitives; clusters of them are binned by block.
#include <numeric>

#include "comm/collectives.h"
#include "loadbalance/owned_blocks.h"
#include "loadbalance/schedule.h"
#include "loadbalance/task_grid.h"
#include "parallel/arena.h"
#include "parallel/parallel_for.h"
#include "raster/distribute/frame_memory.h"
#include "raster/distribute/rank_context.h"
#include "raster/pipeline/cull.h"
#include "raster/pipeline/samples.h"

namespace delray::raster {
namespace {

// A thread that renders one block after the other.
struct Hand {
  parallel::Arena alone{1};
  Scratch scratch;
  RegionCounts counts;
  std::vector<std::uint32_t> done;
};

// Numbers of the clusters that may show in a block, near draws first.
struct Bins {
  std::vector<std::size_t> first;
  std::vector<std::uint32_t> clusters;

  std::span<const std::uint32_t> of(std::uint32_t block) const {
    return std::span(clusters).subspan(first[block], first[block + 1] - first[block]);
  }
};

Bins bin_clusters(const RankContext& rank, const DrawList& list, const PreparedFrame& frame,
                  const loadbalance::Blocks& blocks) {
  std::vector<std::uint32_t> order(list.clusters.size());
  std::iota(order.begin(), order.end(), 0U);
  order =
      nearest_first({rank.screen, list, frame.draws(), rank.screen.frame(), false, {}, {}}, order);
  // Columns and rows of blocks, by place in the order.
  std::vector<geometry::Rect> touched(order.size());
  constexpr std::size_t kGrain = 256;  // clusters
  parallel::parallel_for(0, order.size(), kGrain, [&](std::size_t i) {
    const Cluster& cluster = list.clusters[order[i]];
    const ClusterBounds bounds = bound(rank.screen, frame.draws()[cluster.draw],
                                       list.block_of(cluster).clusters[cluster.part].box);
    if (bounds.outside || bounds.pixels.empty()) return;
    const geometry::Rect pixels = pixels_of(bounds.pixels, rank.options.supersampling);
    touched[i] = {pixels.x0 / blocks.width, pixels.y0 / blocks.height,
                  (pixels.x1 - 1) / blocks.width + 1, (pixels.y1 - 1) / blocks.height + 1};
  });
  const loadbalance::TaskGrid grid = blocks.grid();
  const auto for_each_block = [&](const geometry::Rect& rect, auto&& f) {
    for (int y = rect.y0; y < rect.y1; ++y) {
      for (int x = rect.x0; x < rect.x1; ++x)
        f(static_cast<std::size_t>(y) * grid.columns + static_cast<std::size_t>(x));
    }
  };
  Bins bins;
  bins.first.resize(std::size_t{grid.count()} + 1);
  for (const geometry::Rect& rect : touched)
    for_each_block(rect, [&](std::size_t block) { ++bins.first[block + 1]; });
  std::partial_sum(bins.first.begin(), bins.first.end(), bins.first.begin());
  bins.clusters.resize(bins.first.back());
  std::vector<std::size_t> next(bins.first.begin(), bins.first.end() - 1);
  for (std::size_t i = 0; i < touched.size(); ++i)
    for_each_block(touched[i], [&](std::size_t block) { bins.clusters[next[block]++] = order[i]; });
  return bins;
}

// The blocks of the rank's regions. Collective.
std::vector<loadbalance::TaskRange> blocks_of_regions(RankContext& rank,
                                                      const loadbalance::Blocks& blocks) {
  const auto [begin, end] = rank.own_primitives();
  ScreenPartition& screen = rank.memory.screen;
  screen.groups(rank,
                {begin, end,
                 ScreenPartition::group_triangles(rank.prepared.first_primitives.back(),
                                                  rank.ranks() * rank.options.regions_per_rank)});
  return loadbalance::owned_blocks(screen.cut(rank, rank.ranks()), blocks, rank.number());
}

// Who has rendered which block: all of it on rank 0, a rank's own elsewhere.
loadbalance::Partition rendered(RankContext& rank, const loadbalance::Blocks& blocks,
                                std::span<const std::unique_ptr<Hand>> hands) {
  std::vector<std::uint32_t> mine;
  for (const auto& hand : hands) mine.insert(mine.end(), hand->done.begin(), hand->done.end());
  loadbalance::Partition partition{rank.frame(), {}};
  const auto add = [&](std::span<const std::uint32_t> done, int owner) {
    for (const std::uint32_t block : done)
      partition.regions.push_back({blocks.block(block), owner});
  };
  const std::vector<comm::Buffer> all =
      comm::gather(rank.communicator, 0, comm::Buffer::of(std::span<const std::uint32_t>(mine)));
  if (rank.number() != 0) add(mine, rank.number());
  for (int k = 0; k < static_cast<int>(all.size()); ++k) add(all[k].as<std::uint32_t>(), k);
  return partition;
}

template <class Colour>
Picture render(RankContext& rank) {
  comm::Communicator& communicator = rank.communicator;
  const RenderOptions& options = rank.options;
  communicator.mark(comm::Phase::transform, 0);
  const DrawList list =
      make_draw_list(pieces_of(rank.prepared.scene, rank.prepared.first_primitives, 0,
                               rank.prepared.first_primitives.back()),
                     &rank.prepared.clusters);
  const loadbalance::Blocks blocks{rank.frame(), options.block, options.block};
  const auto task_for = [&](std::span<const geometry::Rect> regions) -> RegionTask {
    return {rank.screen, list,    rank.prepared.shader(),
            options,     regions, rank.depths_are_distances(),
            nullptr};
  };
  const PreparedFrame frame(task_for({}));
  const Bins bins = bin_clusters(rank, list, frame, blocks);

  communicator.mark(comm::Phase::redistribute, 0);
  loadbalance::ScheduleOptions how;
  how.initial = blocks_of_regions(rank, blocks);
  how.master_works = options.master_works;

  communicator.mark(comm::Phase::rasterize, 0);
  auto image = rank.take_image<Colour>(options.width, options.height);
  const Window<Colour> window = window_of(image);
  std::vector<std::unique_ptr<Hand>> hands;
  for (int i = 0; i < parallel::arena_threads(); ++i) hands.push_back(std::make_unique<Hand>());
  if (rank.progress != nullptr) rank.progress->start(blocks.grid().count());
  const auto render_block = [&](std::uint32_t block, int thread) {
    Hand& hand = *hands[thread];
    const RegionCounts done = hand.alone.execute([&] {
      const geometry::Rect region = samples_of(blocks.block(block), options.supersampling);
      RegionDrawing drawing(task_for({&region, 1}), frame, hand.scratch);
      drawing.draw_in_order(bins.of(block));
      return drawing.finish([&](std::span<const geometry::Rect> rects, TileView& tile) {
        store_pixels(rects, tile, options.supersampling, window);
      });
    });
    hand.counts += done;
    if (thread == 0) rank.report_work(done);
    hand.done.push_back(block);
    if (rank.progress != nullptr) rank.progress->advance();
  };
  rank.schedule = loadbalance::find_schedule(options.schedule)
                      ->run(communicator, blocks.grid(), how, render_block);
  for (std::size_t i = 0; i < hands.size(); ++i) {
    rank.counts += hands[i]->counts;
    if (i > 0) rank.report_work(hands[i]->counts);
  }

  communicator.mark(comm::Phase::gather, 0);
  return rank.gather(rendered(rank, blocks, hands), std::move(image));
}

}  // namespace

Picture sort_first_scheduled(RankContext& rank) {
  return rank.options.float_pixels ? render<image::RgbaF>(rank) : render<image::Rgba8>(rank);
}

}  // namespace delray::raster
