#include "raster/internal/screen_partition.h"

#include <algorithm>

#include "loadbalance/costs.h"
#include "parallel/parallel_for.h"
#include "raster/internal/extent.h"
#include "raster/internal/processor_seconds.h"
#include "raster/internal/samples.h"

namespace delray::raster {
namespace {

// Triangles in a group: few enough that its box is small, many enough that its header is not.
constexpr std::uint32_t kGroupTriangles = 256;
// What setting up a triangle costs, in pixels shaded.
constexpr double kTriangleCost = 0.5;

}  // namespace

std::vector<Piece> groups_of(std::span<const Piece> pieces) {
  std::vector<Piece> groups;
  for (const Piece& piece : pieces)
    for (std::uint32_t done = 0; done < piece.count; done += kGroupTriangles)
      groups.push_back({piece.mesh, piece.transform, piece.first + done,
                        std::min(kGroupTriangles, piece.count - done), piece.primitive + done});
  return groups;
}

std::vector<loadbalance::WeightedBox> boxes_of(Rank& rank, std::span<const Piece> groups) {
  const DrawList list = make_draw_list({groups.begin(), groups.end()}, &rank.clusters);
  const std::vector<PreparedDraw> draws =
      prepare_draws(rank.screen, list, rank.shader, rank.options.cull_single_sided);
  // Draws are numbered in the order in which groups first name them.
  std::vector<std::uint32_t> draw_of(groups.size());
  std::uint32_t draw = 0;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (i > 0 && groups[i].transform != groups[i - 1].transform) ++draw;
    draw_of[i] = draw;
  }
  std::vector<loadbalance::WeightedBox> boxes(groups.size());
  ProcessorSeconds seconds;
  parallel::parallel_blocks(0, groups.size(), 4, [&](std::size_t begin, std::size_t end) {
    seconds.measure([&] {
      for (std::size_t i = begin; i < end; ++i) {
        const Extent e = extent(rank.screen, draws[draw_of[i]], groups[i].first, groups[i].count);
        boxes[i].box = pixels_of(e.box, rank.options.supersampling);
        boxes[i].cost =
            e.triangles == 0 ? 0 : kTriangleCost * groups[i].count + static_cast<double>(e.pixels);
      }
    });
  });
  rank.counts.phases.bin += seconds.seconds();
  return boxes;
}

loadbalance::Partition cut_screen(Rank& rank, std::span<const loadbalance::WeightedBox> boxes,
                                  int parts) {
  const geometry::Rect frame = rank.frame();
  const int side = loadbalance::cost_cell_side(frame, parts);
  loadbalance::Costs costs = loadbalance::make_costs(frame, (frame.width() + side - 1) / side,
                                                     (frame.height() + side - 1) / side, boxes);
  loadbalance::sum_over_ranks(costs, rank.communicator);
  return loadbalance::find_partitioner(rank.options.partition)->partition(costs, frame, parts);
}

}  // namespace delray::raster
