// Hybrid distribution (Nebel): sends rays until they have taken as long as fetching the cluster
// would, then fetches it: never more than twice as long as whichever is the better in the end (the
// ski rental problem: Karlin et al. 1988). A cluster that has no room in the cache stays where it
// is, and its rays travel.
#include "raytrace/distributed/distributions.h"

namespace delray::raytrace {

RoutingDecision distribute_hybrid(const WaitingList& waiting) {
  if (!waiting.idle && waiting.rays < kBatchRays) return RoutingDecision::wait;
  const bool pays = waiting.wanted * waiting.ray_seconds >= waiting.cluster_seconds;
  return pays && waiting.has_room ? RoutingDecision::fetch_cluster : RoutingDecision::send_rays;
}

}  // namespace delray::raytrace
