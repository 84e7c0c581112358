// Decides by counts of rays tested when to tell a load and when to give a cluster away: after
// enough work since the last time, and to a neighbour that has done clearly less. Degenerate: a
// neighbour that has told nothing counts as hardly loaded.
#include "raytrace/distributed/ring_loads.h"

namespace delray::raytrace {

bool RingLoads::tell(std::uint64_t load) {
  if (load - told_ < kTestsBetween) return false;
  told_ = load;
  return true;
}

bool RingLoads::should_give(std::uint64_t load) const {
  return load - given_at_ >= kTestsBetween &&
         static_cast<double>(load) >= kMuchMore * static_cast<double>(next_);
}

}  // namespace delray::raytrace
