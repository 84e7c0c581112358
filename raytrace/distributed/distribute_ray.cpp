// Ray distribution (Caspary, Jevans): sends the rays to the owner of the cluster in batches.
#include "raytrace/distributed/distributions.h"

namespace delray::raytrace {

RoutingDecision distribute_ray(const WaitingList& waiting) {
  return waiting.idle || waiting.rays >= kBatchRays ? RoutingDecision::send_rays
                                                    : RoutingDecision::wait;
}

}  // namespace delray::raytrace
