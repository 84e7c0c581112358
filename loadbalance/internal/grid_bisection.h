// A set of grid cells cut in two so that little crosses the cut.
#pragma once

#include <cstdint>
#include <vector>

#include "loadbalance/costs.h"

namespace delray::loadbalance::internal {

class GridBisection {
 public:
  // REQUIRES: `costs` outlives it.
  explicit GridBisection(const Costs& costs);

  // Takes cells out of `cells` (numbers row * columns + column, ascending, at least two) that have
  // about `share` of their cost, at least one and not all, and returns them, ascending: grown from
  // a corner of the set, next the cell that is tied most to those inside and least to those outside
  // (greedy graph growing, Karypis and Kumar 1998), or row by row or column by column, whichever of
  // these six leaves least crossing; then cells change sides at the border as long as less crosses
  // it and the balance allows (Fiduccia and Mattheyses 1982). O(cells log cells).
  std::vector<std::uint32_t> take(std::vector<std::uint32_t>& cells, double share);

 private:
  enum class Side : std::uint8_t { none, inside, outside };
  struct Growth {
    std::vector<std::uint32_t> taken;
    double cost = 0, crossing = 0;
  };
  Growth grow(const std::vector<std::uint32_t>& cells, std::uint32_t seed, double wanted);
  // Cells in `order` up to the wanted cost.
  Growth sweep(const std::vector<std::uint32_t>& cells, const std::vector<std::uint32_t>& order,
               double wanted);
  void refine(const std::vector<std::uint32_t>& cells, double wanted, double inside_cost);
  // Calls f(neighbour, tie) for the neighbours of a cell that are in the set.
  template <class F>
  void for_each_neighbour(std::uint32_t cell, F&& f) const;
  // How much less would cross if the cell changed sides.
  double gain(std::uint32_t cell) const;

  std::uint32_t columns_, rows_;
  std::vector<double> costs_, right_, down_;  // right_, down_: ties to the next cell
  std::vector<Side> side_;                    // `none` for cells that are not in the set
};

}  // namespace delray::loadbalance::internal
