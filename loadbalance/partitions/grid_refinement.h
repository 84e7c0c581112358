// Cells that change sides where that leaves less crossing.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "loadbalance/partitions/grid_graph.h"

namespace delray::loadbalance::internal {

// By gain, of equal ones the first cell.
struct GridMove {
  double gain;
  std::uint32_t cell;
  bool operator<(const GridMove& other) const {
    return gain != other.gain ? gain < other.gain : cell > other.cell;
  }
};

// The cells inside.
struct GridHalf {
  double wanted = 0, tolerance = 0;  // what they are to cost, and how far they may be from that
  double cost = 0, crossing = 0;     // what they do, and the sum of their ties to cells outside
  std::size_t count = 0;
};

class GridRefinement {
 public:
  // Passes in which cells move from one side to the other, each once, the one with the highest gain
  // first, also where that is below 0, and are put back beyond where least crossed (Fiduccia and
  // Mattheyses 1982); what the inside costs stays within the tolerance or gets nearer
  // to it. Only cells at the border are looked at, which `near` holds to begin with,
  // among others if need be; `cells` is how many the set has.
  // O(moves log moves); a pass ends some moves after the best.
  void refine(GridGraph& graph, std::vector<std::uint32_t>& near, std::size_t cells,
              GridHalf& half);

  // The number of cells visited, for tests.
  std::uint64_t looked_at() const { return looked_at_; }

 private:
  bool pass(GridGraph& graph, std::vector<std::uint32_t>& near, std::size_t cells, GridHalf& half);

  std::vector<GridMove> border_;  // a heap
  std::vector<std::uint32_t> moves_;
  std::uint64_t looked_at_ = 0;
};

}  // namespace delray::loadbalance::internal
