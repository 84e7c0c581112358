// Refinement of a cut by passes of single moves (Fiduccia and Mattheyses 1982).
//
// A heap gives the border cell with the highest gain; it moves, once in a pass, if that keeps or
// improves the balance, and its neighbours get new entries, since entries with an old gain are
// skipped. A pass ends some moves after the best state and goes back to it. O(moves log moves).
//
// Degenerate: the last cell of a side never moves; cells of hardly any cost are not moved to mend
// the balance.
#include "loadbalance/partitions/grid_refinement.h"

#include <algorithm>
#include <cmath>

namespace delray::loadbalance::internal {
namespace {

constexpr int kPasses = 4;
// Moves without gain after which a pass ends.
constexpr std::size_t kPatience = 64;
// Costs that do not count when the balance is off, over about the mean cost.
constexpr double kNegligible = 0.1;

}  // namespace

bool GridRefinement::pass(GridGraph& graph, std::vector<std::uint32_t>& near, std::size_t cells,
                          GridHalf& half) {
  border_.clear();
  const auto push = [&](std::uint32_t cell) {
    border_.push_back({graph.gain(cell), cell});
    std::push_heap(border_.begin(), border_.end());
  };
  looked_at_ += near.size();
  std::erase_if(near, [&](std::uint32_t cell) { return !graph.at_border(cell); });
  for (const std::uint32_t cell : near) border_.push_back({graph.gain(cell), cell});
  std::make_heap(border_.begin(), border_.end());

  const auto excess = [&](double cost) {
    return std::max(0.0, std::abs(cost - half.wanted) - half.tolerance);
  };
  const auto flip = [&](std::uint32_t cell) {
    const bool leaves = graph.is_inside(cell);
    graph.put_inside(cell, !leaves);
    half.cost += leaves ? -graph.cost(cell) : graph.cost(cell);
    half.count += leaves ? std::size_t(-1) : 1;
  };
  const double negligible = kNegligible * half.wanted / static_cast<double>(cells);
  moves_.clear();
  std::size_t best = 0;
  double gained = 0, best_gained = 0, best_excess = excess(half.cost);
  while (!border_.empty() && moves_.size() < best + kPatience) {
    const auto [value, cell] = border_.front();
    std::pop_heap(border_.begin(), border_.end());
    border_.pop_back();
    ++looked_at_;
    if (graph.is_marked(cell) || value != graph.gain(cell)) continue;
    const bool leaves = graph.is_inside(cell);
    if (leaves ? half.count == 1 : half.count + 1 == cells) continue;
    const double then = half.cost + (leaves ? -graph.cost(cell) : graph.cost(cell));
    if (excess(then) > 0 && std::abs(then - half.wanted) > std::abs(half.cost - half.wanted))
      continue;
    // Many cells of next to no cost would change sides before one that mends the balance.
    if (excess(half.cost) > 0 && value <= 0 && graph.cost(cell) < negligible) continue;
    flip(cell);
    graph.mark(cell, true);
    moves_.push_back(cell);
    gained += value;
    const double left = excess(half.cost);
    if (left < best_excess ||
        (left == best_excess && gained - best_gained > 1e-9 * std::abs(best_gained))) {
      best_excess = left;
      best_gained = gained;
      best = moves_.size();
    }
    graph.for_each_neighbour(cell, [&](std::uint32_t neighbour, double) {
      if (!graph.is_marked(neighbour)) push(neighbour);
    });
  }
  for (std::size_t k = moves_.size(); k > best; --k) flip(moves_[k - 1]);
  for (const std::uint32_t cell : moves_) graph.mark(cell, false);
  for (std::size_t k = 0; k < best; ++k) {
    near.push_back(moves_[k]);
    graph.for_each_neighbour(moves_[k],
                             [&](std::uint32_t neighbour, double) { near.push_back(neighbour); });
  }
  half.crossing -= best_gained;
  return best > 0;
}

void GridRefinement::refine(GridGraph& graph, std::vector<std::uint32_t>& near, std::size_t cells,
                            GridHalf& half) {
  for (int k = 0; k < kPasses && pass(graph, near, cells, half); ++k) {
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
  }
}

}  // namespace delray::loadbalance::internal
