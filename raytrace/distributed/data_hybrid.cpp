#include "raytrace/distributed/distributions.h"

namespace delray::raytrace {

// A ray comes back, and whoever fetches a cluster keeps it for the rays that come later.
Meeting meet_by_either(const WaitingList& waiting) {
  if (!waiting.hungry && waiting.rays < kBatchRays) return Meeting::wait;
  return 2 * waiting.ray_bytes > waiting.cluster_bytes ? Meeting::fetch_cluster
                                                       : Meeting::send_rays;
}

}  // namespace delray::raytrace
