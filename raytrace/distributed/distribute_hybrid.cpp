// Hybrid distribution (Nebel): sends the rays or fetches the cluster, whichever takes fewer bytes.
#include "raytrace/distributed/distributions.h"

namespace delray::raytrace {

// A ray comes back, and whoever fetches a cluster keeps it for the rays that come later.
RoutingDecision distribute_hybrid(const WaitingList& waiting) {
  if (!waiting.idle && waiting.rays < kBatchRays) return RoutingDecision::wait;
  return 2 * waiting.ray_bytes > waiting.cluster_bytes ? RoutingDecision::fetch_cluster
                                                       : RoutingDecision::send_rays;
}

}  // namespace delray::raytrace
