#include "raytrace/distributed/distributions.h"

namespace delray::raytrace {

Meeting meet_by_ray(const WaitingList& waiting) {
  return waiting.hungry || waiting.rays >= kBatchRays ? Meeting::send_rays : Meeting::wait;
}

}  // namespace delray::raytrace
