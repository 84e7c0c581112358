#include "raytrace/distributed/distributions.h"

namespace delray::raytrace {

// A few rays may wait until others want the same: the cluster might be dropped before they come.
Meeting meet_by_object(const WaitingList& waiting) {
  return waiting.hungry || waiting.rays >= kBatchRays ? Meeting::fetch_cluster : Meeting::wait;
}

}  // namespace delray::raytrace
