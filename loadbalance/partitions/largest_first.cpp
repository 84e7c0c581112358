// Longest processing time first (Graham 1969) with a heap of ranks, for loads and for the regions
// of a partition. O(n log n + n log ranks). Degenerate: items without load all go to the rank that
// has least; without any load the imbalance is 1.
#include "loadbalance/partitions/largest_first.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <stdexcept>
#include <utility>

#include "loadbalance/partition.h"

namespace delray::loadbalance {

std::vector<int> internal::largest_first(std::span<const double> loads, int ranks) {
  std::vector<int> order(loads.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return loads[a] > loads[b]; });
  using Load = std::pair<double, int>;  // of a rank, and its number
  std::priority_queue<Load, std::vector<Load>, std::greater<>> least;
  for (int rank = 0; rank < ranks; ++rank) least.emplace(0, rank);
  std::vector<int> rank_of(loads.size());
  for (const int item : order) {
    const auto [load, rank] = least.top();
    least.pop();
    rank_of[item] = rank;
    least.emplace(load + loads[item], rank);
  }
  return rank_of;
}

Partition assign_largest_first(const Costs& costs, const Partition& regions, int ranks) {
  if (ranks < 1) throw std::invalid_argument("there is at least one rank");
  int owners = 0;
  for (const Region& region : regions.regions) owners = std::max(owners, region.owner + 1);
  const std::vector<int> rank_of = internal::largest_first(loads(costs, regions, owners), ranks);
  Partition result = regions;
  for (Region& region : result.regions) region.owner = rank_of[region.owner];
  return result;
}

Partition partition_for_ranks(const Partitioner& partitioner, const Costs& costs, int ranks,
                              int regions_per_rank) {
  if (ranks < 1 || regions_per_rank < 1 ||
      ranks > std::numeric_limits<int>::max() / regions_per_rank)
    throw std::invalid_argument("there is at least one rank, with at least one region");
  Partition regions = partitioner.partition(costs, costs.frame, ranks * regions_per_rank);
  if (regions_per_rank == 1) return regions;
  return assign_largest_first(costs, regions, ranks);
}

double imbalance(std::span<const double> loads) {
  const double total = std::accumulate(loads.begin(), loads.end(), 0.0);
  if (!(total > 0)) return 1;
  return *std::max_element(loads.begin(), loads.end()) * static_cast<double>(loads.size()) / total;
}

}  // namespace delray::loadbalance
