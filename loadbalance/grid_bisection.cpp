#include "loadbalance/internal/grid_bisection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <utility>

namespace delray::loadbalance::internal {
namespace {

// Ties of cells that nothing crosses, over the mean tie: keeps regions compact there.
constexpr double kLeastTie = 1;
// How far refinement may leave the wanted cost, in parts of it.
constexpr double kTolerance = 0.02;
constexpr int kPasses = 4;
// Moves without gain after which a pass ends.
constexpr int kPatience = 64;

// By gain, of equal ones the first cell.
struct Candidate {
  double gain;
  std::uint32_t cell;
  bool operator<(const Candidate& other) const {
    return gain != other.gain ? gain < other.gain : cell > other.cell;
  }
};

}  // namespace

GridBisection::GridBisection(const Costs& costs)
    : columns_(static_cast<std::uint32_t>(costs.columns)),
      rows_(static_cast<std::uint32_t>(costs.rows)),
      costs_(costs.cells),
      right_(costs.cross_right),
      down_(costs.cross_down),
      side_(costs.cells.size(), Side::none) {
  double sum = 0, total = 0;
  for (const double tie : right_) sum += tie;
  for (const double tie : down_) sum += tie;
  const double least =
      sum > 0 ? kLeastTie * sum / static_cast<double>(right_.size() + down_.size()) : 1;
  for (double& tie : right_) tie += least;
  for (double& tie : down_) tie += least;
  // Cells without cost get a little, so that sets of them are cut by their number.
  for (const double cost : costs_) total += cost;
  const double little = total > 0 ? 1e-6 * total / static_cast<double>(costs_.size()) : 1;
  for (double& cost : costs_) cost += little;
}

template <class F>
void GridBisection::for_each_neighbour(std::uint32_t cell, F&& f) const {
  const std::uint32_t column = cell % columns_;
  const auto visit = [&](std::uint32_t neighbour, double tie) {
    if (side_[neighbour] != Side::none) f(neighbour, tie);
  };
  if (column > 0) visit(cell - 1, right_[cell - 1]);
  if (column + 1 < columns_) visit(cell + 1, right_[cell]);
  if (cell >= columns_) visit(cell - columns_, down_[cell - columns_]);
  if (cell + columns_ < columns_ * rows_) visit(cell + columns_, down_[cell]);
}

double GridBisection::gain(std::uint32_t cell) const {
  double gain = 0;
  for_each_neighbour(cell, [&](std::uint32_t neighbour, double tie) {
    gain += side_[neighbour] == side_[cell] ? -tie : tie;
  });
  return gain;
}

GridBisection::Growth GridBisection::grow(const std::vector<std::uint32_t>& cells,
                                          std::uint32_t seed, double wanted) {
  for (const std::uint32_t cell : cells) side_[cell] = Side::outside;
  Growth growth;
  std::priority_queue<Candidate> border;
  border.push({gain(seed), seed});
  std::size_t next = 0;  // where to go on when the set is in several pieces
  while (growth.taken.size() + 1 < cells.size()) {
    while (!border.empty() && (side_[border.top().cell] == Side::inside ||
                               border.top().gain != gain(border.top().cell))) {
      border.pop();  // taken, or pushed again with another gain
    }
    if (border.empty()) {
      while (side_[cells[next]] == Side::inside) ++next;
      border.push({gain(cells[next]), cells[next]});
    }
    const auto [lost, cell] = border.top();
    const double with = growth.cost + costs_[cell];
    if (!growth.taken.empty() && with - wanted > wanted - growth.cost) break;
    border.pop();
    side_[cell] = Side::inside;
    growth.taken.push_back(cell);
    growth.cost = with;
    growth.crossing -= lost;
    if (with >= wanted) break;
    for_each_neighbour(cell, [&](std::uint32_t neighbour, double) {
      if (side_[neighbour] == Side::outside) border.push({gain(neighbour), neighbour});
    });
  }
  return growth;
}

GridBisection::Growth GridBisection::sweep(const std::vector<std::uint32_t>& cells,
                                           const std::vector<std::uint32_t>& order, double wanted) {
  for (const std::uint32_t cell : cells) side_[cell] = Side::outside;
  Growth growth;
  for (const std::uint32_t cell : order) {
    const double with = growth.cost + costs_[cell];
    const bool is_last = growth.taken.size() + 1 == cells.size();
    if (is_last || (!growth.taken.empty() && with - wanted > wanted - growth.cost)) break;
    growth.crossing -= gain(cell);
    side_[cell] = Side::inside;
    growth.taken.push_back(cell);
    growth.cost = with;
  }
  return growth;
}

void GridBisection::refine(const std::vector<std::uint32_t>& cells, double wanted,
                           double inside_cost) {
  std::size_t inside_count = 0;
  for (const std::uint32_t cell : cells) inside_count += side_[cell] == Side::inside ? 1 : 0;
  std::vector<std::uint8_t> moved(side_.size());
  for (int pass = 0; pass < kPasses; ++pass) {
    std::priority_queue<Candidate> border;
    for (const std::uint32_t cell : cells) {
      moved[cell] = 0;
      bool at_border = false;
      for_each_neighbour(cell, [&](std::uint32_t neighbour, double) {
        at_border = at_border || side_[neighbour] != side_[cell];
      });
      if (at_border) border.push({gain(cell), cell});
    }
    std::vector<std::uint32_t> moves;
    std::size_t best = 0;
    double sum = 0, best_sum = 0;
    const auto flip = [&](std::uint32_t cell) {
      const bool leaves = side_[cell] == Side::inside;
      side_[cell] = leaves ? Side::outside : Side::inside;
      inside_cost += leaves ? -costs_[cell] : costs_[cell];
      inside_count += leaves ? std::size_t(-1) : 1;
    };
    while (!border.empty() && moves.size() < best + kPatience) {
      const auto [value, cell] = border.top();
      border.pop();
      if (moved[cell] != 0 || value != gain(cell)) continue;
      const bool leaves = side_[cell] == Side::inside;
      const std::size_t count = inside_count + (leaves ? std::size_t(-1) : 1);
      if (count == 0 || count == cells.size()) continue;
      const double off = std::abs(inside_cost - wanted);
      const double then = std::abs(inside_cost + (leaves ? -costs_[cell] : costs_[cell]) - wanted);
      if (then > off && then > kTolerance * wanted) continue;
      flip(cell);
      moved[cell] = 1;
      moves.push_back(cell);
      sum += value;
      if (sum > best_sum * (1 + 1e-9)) {
        best_sum = sum;
        best = moves.size();
      }
      for_each_neighbour(cell, [&](std::uint32_t neighbour, double) {
        if (moved[neighbour] == 0) border.push({gain(neighbour), neighbour});
      });
    }
    for (std::size_t k = moves.size(); k > best; --k) flip(moves[k - 1]);
    if (best == 0) break;
  }
}

std::vector<std::uint32_t> GridBisection::take(std::vector<std::uint32_t>& cells, double share) {
  double total = 0;
  std::array<std::uint32_t, 4> corners;
  corners.fill(cells.front());
  const auto column = [&](std::uint32_t cell) { return std::int64_t{cell % columns_}; };
  const auto row = [&](std::uint32_t cell) { return std::int64_t{cell / columns_}; };
  for (const std::uint32_t cell : cells) {
    total += costs_[cell];
    const auto further = [&](std::uint32_t& corner, int x, int y) {
      if (x * column(cell) + y * row(cell) > x * column(corner) + y * row(corner)) corner = cell;
    };
    further(corners[0], -1, -1);
    further(corners[1], 1, -1);
    further(corners[2], -1, 1);
    further(corners[3], 1, 1);
  }
  const double wanted = total * share;
  Growth best;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    if (std::find(corners.begin(), corners.begin() + k, corners[k]) != corners.begin() + k)
      continue;
    Growth growth = grow(cells, corners[k], wanted);
    if (best.taken.empty() || growth.crossing < best.crossing) best = std::move(growth);
  }
  std::vector<std::uint32_t> by_column = cells;
  std::stable_sort(by_column.begin(), by_column.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return column(a) < column(b); });
  for (const auto* order : {&cells, &by_column}) {
    Growth growth = sweep(cells, *order, wanted);
    if (growth.crossing < best.crossing) best = std::move(growth);
  }
  for (const std::uint32_t cell : cells) side_[cell] = Side::outside;
  for (const std::uint32_t cell : best.taken) side_[cell] = Side::inside;
  refine(cells, wanted, best.cost);

  std::vector<std::uint32_t> taken, left;
  for (const std::uint32_t cell : cells) {
    (side_[cell] == Side::inside ? taken : left).push_back(cell);
    side_[cell] = Side::none;
  }
  cells = std::move(left);
  return taken;
}

}  // namespace delray::loadbalance::internal
