// Hybrid distribution by loads (Nebel 1998): a rank that has more rays to intersect than the one
// that has fewest sends those that wait for a cluster to its owner, if they are enough and the
// owner has fewer than itself; else it fetches what enough of its rays wait for.
#include "raytrace/distributed/distributions.h"

namespace delray::raytrace {

RoutingDecision distribute_by_load(const WaitingList& waiting) {
  if (!waiting.idle && waiting.rays < kBatchRays) return RoutingDecision::wait;
  const bool has_more =
      waiting.own_load > waiting.least_load && waiting.own_load > waiting.owner_load;
  return has_more ? RoutingDecision::send_rays : RoutingDecision::fetch_cluster;
}

}  // namespace delray::raytrace
