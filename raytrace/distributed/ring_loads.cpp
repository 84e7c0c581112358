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
