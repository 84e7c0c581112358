// Which clusters of other ranks stay in a cache that is too small for all that rays meet.
#pragma once

#include <cstdint>
#include <vector>

namespace delray::raytrace {

// A cluster that rays have met.
struct MetCluster {
  std::uint32_t cluster = 0;
  double rays = 0.0;        // that have met it
  std::uint64_t bytes = 0;  // that it takes in the cache
  bool kept = false;        // in the last frame
};

// The clusters that most rays have met for each byte, most first, while they fit into `room`. One
// that is kept already makes way for one only that is much more in demand. O(n log n).
std::vector<std::uint32_t> choose_kept(std::vector<MetCluster> met, std::uint64_t room);

}  // namespace delray::raytrace
