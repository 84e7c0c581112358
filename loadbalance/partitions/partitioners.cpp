// The table of partitions, looked up by name, and the check of the costs that all of them make
// first.
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "files/find_named.h"
#include "loadbalance/partitions/partitioners.h"

namespace delray::loadbalance {
namespace {

constexpr std::array kPartitioners = {
    Partitioner{"mahd", "rectangles of equal cost, from a summed-area table (Mueller)",
                &internal::mahd, "bisection"},
    Partitioner{"kd-split",
                "rectangles, cut where a sweep line has equal costs on both sides (Samanta)",
                &internal::kd_split, "bisection"},
    Partitioner{"graph",
                "regions of any shape whose borders few primitives cross, grown on a grid (Kurc)",
                &internal::graph, "graph"},
    Partitioner{"whitman", "ten quadtree leaves per rank, the fullest assigned first (Whitman)",
                &internal::whitman, "grid"},
    Partitioner{
        "whelan",
        "rectangles with equally many primitives, by median cut of their centroids (Whelan)",
        &internal::whelan, "bisection"},
    Partitioner{"roble", "grid cells, of which full ones are halved and empty ones merged (Roble)",
                &internal::roble, "grid"},
    Partitioner{
        "pixel-planes",
        "square blocks of 128 pixels, the costliest first to who has least (Pixel-Planes 5)",
        &internal::pixel_planes, "grid"},
    Partitioner{"infinite-reality",
                "fine square blocks of 16 pixels assigned in turn, whatever they cost "
                "(InfiniteReality)",
                &internal::infinite_reality, "fixed"},
    Partitioner{"interlaced", "many square blocks assigned in turn, whatever they cost",
                &internal::interlaced, "fixed"},
};

}  // namespace

std::span<const Partitioner> partitioners() { return kPartitioners; }

void internal::check_costs(const Costs& costs, geometry::Rect frame, int parts) {
  if (parts < 1) throw std::invalid_argument("a partition has at least one part");
  if (!(frame == costs.frame))
    throw std::invalid_argument("the costs are of another frame than the partition");
  const auto cells = static_cast<std::size_t>(std::max(0, costs.columns)) *
                     static_cast<std::size_t>(std::max(0, costs.rows));
  if (costs.cells.size() != cells || costs.cross_right.size() != cells ||
      costs.cross_down.size() != cells) {
    throw std::invalid_argument("the costs are not of " + std::to_string(costs.columns) + " x " +
                                std::to_string(costs.rows) + " cells");
  }
  const auto is_cost = [](double cost) { return std::isfinite(cost) && cost >= 0; };
  if (!std::ranges::all_of(costs.cells, is_cost) ||
      !std::ranges::all_of(costs.boxes, is_cost, &WeightedBox::cost))
    throw std::invalid_argument("a cost is negative or not finite");
}

const Partitioner* find_partitioner(std::string_view name) {
  return files::find_named(partitioners(), name);
}

}  // namespace delray::loadbalance
