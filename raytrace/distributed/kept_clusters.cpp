// Greedy by value per byte, as for the knapsack problem (Dantzig 1957). What was used last says
// little where rays ask for more clusters than there is room for, one after the other: each would
// be dropped before it is asked for again.
//
// Degenerate: a cluster larger than what room is left is passed over for smaller ones.
#include "raytrace/distributed/kept_clusters.h"

#include <algorithm>

namespace delray::raytrace {
namespace {

// So many times as much in demand: clusters must not come and go from frame to frame.
constexpr double kMuchMore = 2.0;

double demand(const MetCluster& met) {
  return (met.kept ? kMuchMore : 1.0) * met.rays /
         static_cast<double>(std::max<std::uint64_t>(1, met.bytes));
}

}  // namespace

std::vector<std::uint32_t> choose_kept(std::vector<MetCluster> met, std::uint64_t room) {
  std::sort(met.begin(), met.end(), [](const MetCluster& a, const MetCluster& b) {
    return demand(a) != demand(b) ? demand(a) > demand(b) : a.cluster < b.cluster;
  });
  std::vector<std::uint32_t> chosen;
  for (const MetCluster& each : met) {
    if (!(each.rays > 0.0) || each.bytes > room) continue;
    room -= each.bytes;
    chosen.push_back(each.cluster);
  }
  return chosen;
}

}  // namespace delray::raytrace
