// Measures a partition by its boxes: a RegionIndex finds the owners of each box, and every owner is
// charged the setup of the box and its share of the rest by pixels. Degenerate: without boxes the
// imbalance and the overlap are 1.
#include "loadbalance/balance.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <string>

#include "loadbalance/region_index.h"

namespace delray::loadbalance {

Balance balance(const Partition& partition, std::span<const WeightedBox> boxes, int owners) {
  if (owners < 1) throw std::invalid_argument("there is at least one owner");
  for (const Region& region : partition.regions) {
    if (region.owner < 0 || region.owner >= owners)
      throw std::invalid_argument("a region's owner is none of " + std::to_string(owners));
  }
  Balance result;
  result.loads.assign(static_cast<std::size_t>(owners), 0);
  const RegionIndex index(partition);
  std::vector<int> seen;
  double pairs = 0;
  for (const WeightedBox& box : boxes) {
    const auto area = geometry::intersection(box.box, partition.frame).area();
    if (area == 0) continue;
    const double density = (box.cost - box.setup) / static_cast<double>(area);
    seen.clear();
    index.for_each_region(box.box, [&](const Region& region, const geometry::Rect& common) {
      result.loads[region.owner] += density * static_cast<double>(common.area());
      seen.push_back(region.owner);
    });
    std::sort(seen.begin(), seen.end());
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    for (const int owner : seen) result.loads[owner] += box.setup;
    result.alone += box.cost;
    result.primitives += box.primitives;
    if (seen.size() > 1) result.shared += box.primitives;
    pairs += static_cast<double>(seen.size()) * static_cast<double>(box.primitives);
  }
  result.imbalance = imbalance(result.loads);
  if (result.primitives > 0) result.overlap = pairs / static_cast<double>(result.primitives);
  if (result.alone > 0) {
    result.over_share =
        *std::max_element(result.loads.begin(), result.loads.end()) * owners / result.alone;
  }
  return result;
}

PartitionReport report(const Partitioner& partitioner, const Costs& costs, int ranks,
                       int regions_per_rank) {
  PartitionReport result;
  const auto begin = std::chrono::steady_clock::now();
  result.partition = partition_for_ranks(partitioner, costs, ranks, regions_per_rank);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  result.predicted = imbalance(loads(costs, result.partition, ranks));
  result.balance = balance(result.partition, costs.boxes, ranks);
  return result;
}

}  // namespace delray::loadbalance
