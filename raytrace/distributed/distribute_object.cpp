// Object distribution (Badouel, Wald): fetches the cluster when enough rays wait for it.
#include "raytrace/distributed/distributions.h"

namespace delray::raytrace {

// A few rays may wait until others want the same: the cluster might be dropped before they come.
RoutingDecision distribute_object(const WaitingList& waiting) {
  return waiting.idle || waiting.rays >= kBatchRays ? RoutingDecision::fetch_cluster
                                                    : RoutingDecision::wait;
}

}  // namespace delray::raytrace
